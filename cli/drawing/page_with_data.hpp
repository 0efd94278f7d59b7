#pragma once

#include <string>
#include <string_view>

namespace cli::inline drawings {

/// What a page that plays frames has of its own: the id of the element with its data, its style beside that
/// of all such pages, what stands below its heading, and its script.
struct PlayedPage {
  std::string_view data_id, style, body, script;
};

/// The page, complete in itself, with its data as a JSON object. Nothing in title or data can end the element
/// that it stands in.
std::string page_with_data(const PlayedPage&, const std::string& title, const std::string& data);

}  // namespace cli::inline drawings
