#pragma once

#include <string>
#include <string_view>

namespace cli {

/// A page with a JSON object in it: what comes before, with the title for @TITLE@, the data, what comes
/// after. Nothing in title or data can end the element that it stands in.
std::string page_with_data(std::string_view before, const std::string& title, const std::string& data,
                           std::string_view after);

}  // namespace cli
