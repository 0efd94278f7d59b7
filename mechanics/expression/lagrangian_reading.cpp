#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "mechanics/expression/assignment.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/expression/zero_set.hpp"

namespace mechanics::expression {
namespace {

/// Reads the parts of the text in the order in which they need each other.
class Reading {
 public:
  Reading(const LagrangianText& text, LagrangianModel& model)
      : text_(text), model_(model), meanings_(model.meanings), expansion_(model.meanings, model.tape) {}

  void read() {
    meanings_.table_file = text_.table_file;
    declare_names();
    read_parameters();
    read_coordinates();
    read_definitions();
    read_constraints();
    read_energies();
    for (std::uint32_t d = 0; d < meanings_.entry_of.size(); ++d)
      expansion_.definition(d);  // the unused, too, are checked
    check_dependence();
    build_programs();
  }

  void gather_mistakes(const StateText& state, convex::Mistakes& mistakes) {
    if (!mistakes.gather([&] { declare_names(); })) return;  // whatever uses the name would be told, too
    const Scope everything{&model_.names, Vocabulary::system, {}};
    const auto gather = [&](const Text& value, const std::string& what, const Scope& scope) {
      mistakes.gather([&] { parse_expression(model_.sources.add(value, what), scope); });
    };
    for (const NamedText& p : text_.parameters)
      gather(p.value, told(p), {&model_.names, Vocabulary::parameters, {}});
    for (const Source* key : coordinate_keys_) mistakes.gather([&] { parse_key(*key, model_.names, true); });
    gather(text_.kinetic, "kinetic", everything);
    if (text_.potential) gather(*text_.potential, "potential", everything);
    if (state.t) gather(*state.t, "t of the state", everything);
    const auto gather_in = [&](const std::vector<NamedText>& texts, const char* table, const char* value_of) {
      const bool are_constraints = &texts == &text_.constraints;
      const bool are_of_coordinates = !are_constraints && &texts != &text_.definitions;
      for (const NamedText& text : texts)
        mistakes.gather([&] {
          const Key key = parse_key(model_.sources.add(text.name, table), model_.names, false);
          if (are_of_coordinates) coordinate_named(key, model_.names);
          const Source& value = model_.sources.add(text.value, value_of + text.name.text);
          const Scope scope{&model_.names, Vocabulary::system, key.index_names()};
          if (are_constraints)
            parse_relation(value, scope);
          else
            parse_expression(value, scope);
        });
    };
    gather_in(text_.definitions, "definitions", "definition ");
    gather_in(text_.forces, "forces", "force on ");
    gather_in(text_.constraints, "constraints", "constraint ");
    gather_in(state.position, "position", "position of ");
    gather_in(state.velocity, "velocity", "velocity of ");
  }

 private:
  struct Group {  // the keys of one family, in the file's order
    std::string name;
    std::vector<std::uint32_t> entries;
  };

  static std::string told(const NamedText& parameter) {
    return parameter.told_as.empty() ? "parameter " + parameter.name.text : parameter.told_as;
  }

  void declare_names() {
    for (const NamedText& p : text_.parameters) {
      const Source& key = model_.sources.add(p.name, "parameters");
      const KeyName name = parse_key_name(key);
      if (name.indices > 0) key.fail(0, "a parameter has no index; make a family of definitions of it");
      const auto number = static_cast<std::uint32_t>(meanings_.parameter_names.size());
      const Name meaning{Name::Kind::parameter, number, 0};
      if (p.told_as.empty())
        model_.names.declare(name.name, meaning, key, 0);
      else
        model_.names.declare_unlisted(name.name, meaning, key, 0);
      meanings_.parameter_names.push_back(name.name);
    }
    for (std::size_t i = 0; i < text_.coordinates.size(); ++i) {
      const Source& key = model_.sources.add(text_.coordinates[i], "coordinates");
      const KeyName name = parse_key_name(key);
      model_.names.declare(name.name, {Name::Kind::coordinate, static_cast<std::uint32_t>(i), name.indices},
                           key, 0);
      coordinate_keys_.push_back(&key);
    }
    declare_families(text_.definitions, Name::Kind::definition, "definitions", definition_groups_,
                     definition_keys_);
    declare_families(text_.constraints, Name::Kind::constraint, "constraints", constraint_groups_,
                     constraint_keys_);
  }

  void declare_families(const std::vector<NamedText>& texts, Name::Kind kind, const char* table,
                        std::vector<Group>& groups, std::vector<const Source*>& keys) {
    for (std::uint32_t e = 0; e < texts.size(); ++e) {
      const Source& key = model_.sources.add(texts[e].name, table);
      const KeyName name = parse_key_name(key);
      keys.push_back(&key);
      const Name* known = model_.names.find(name.name);
      if (known != nullptr && known->kind == kind && known->indices == name.indices && name.indices > 0) {
        groups[known->index].entries.push_back(e);
      } else {
        model_.names.declare(name.name, {kind, static_cast<std::uint32_t>(groups.size()), name.indices}, key,
                             0);
        groups.push_back({name.name, {e}});
      }
    }
  }

  void read_parameters() {
    for (std::size_t p = 0; p < text_.parameters.size(); ++p) {
      const Source& value = model_.sources.add(text_.parameters[p].value, told(text_.parameters[p]));
      meanings_.parameters.push_back(parse_expression(value, {&model_.names, Vocabulary::parameters, {}}));
    }
    for (std::uint32_t p = 0; p < meanings_.parameters.size(); ++p) expansion_.parameter(p);
  }

  void read_coordinates() {
    double n = 0;
    for (const Source* source : coordinate_keys_) {
      const Key key = parse_key(*source, model_.names, true);
      Family family{key.name, Members(), static_cast<std::uint32_t>(n)};
      if (!key.indices.empty())
        family.members =
            Members(static_cast<std::uint32_t>(key.indices.size()), tuples(key, nullptr, expansion_));
      n += family.members.size();
      if (n > most_members) source->fail(0, "there are more than 1e7 coordinates; use fewer");
      for (std::uint32_t m = 0; m < family.members.size(); ++m)
        model_.coordinates.push_back(member_name(family.name, family.members[m]));
      meanings_.coordinate_families.push_back(std::move(family));
    }
  }

  std::vector<Entry> read_entries(const std::vector<NamedText>& texts, const std::vector<const Source*>& keys,
                                  const std::string& what, std::vector<bool>* two_sided) {
    std::vector<Entry> entries;
    for (std::size_t e = 0; e < texts.size(); ++e) {
      Key key = parse_key(*keys[e], model_.names, false);
      const Source& value = model_.sources.add(texts[e].value, what + texts[e].name.text);
      const Scope scope{&model_.names, Vocabulary::system, key.index_names()};
      if (two_sided == nullptr) {
        entries.push_back({std::move(key), parse_expression(value, scope)});
      } else {
        Relation relation = parse_relation(value, scope);
        entries.push_back({std::move(key), std::move(relation.f)});
        two_sided->push_back(relation.two_sided);
      }
    }
    return entries;
  }

  void read_definitions() {
    meanings_.definitions = read_entries(text_.definitions, definition_keys_, "definition ", nullptr);
    for (const Group& group : definition_groups_) {
      Defined defined = define(meanings_.definitions, group.entries, expansion_);
      const auto number = static_cast<std::uint32_t>(meanings_.definition_families.size());
      meanings_.definition_families.push_back(
          {group.name, std::move(defined.members), static_cast<std::uint32_t>(meanings_.entry_of.size())});
      meanings_.entry_of.insert(meanings_.entry_of.end(), defined.entry_of.begin(), defined.entry_of.end());
      meanings_.family_of.insert(meanings_.family_of.end(), defined.entry_of.size(), number);
    }
  }

  void read_constraints() {
    std::vector<bool> two_sided;
    const std::vector<Entry> entries =
        read_entries(text_.constraints, constraint_keys_, "constraint ", &two_sided);
    for (const Group& group : constraint_groups_) {
      const Defined defined = define(entries, group.entries, expansion_);
      for (std::uint32_t m = 0; m < defined.members.size(); ++m) {
        const std::uint32_t e = defined.entry_of[m];
        const Tuple tuple = defined.members[m];
        model_.constraints.push_back(
            {member_name(group.name, tuple), two_sided[e], entries[e].key.source->text.begin});
        const NodeId f = expansion_.node(entries[e].value, tuple);
        refuse_velocities(f, entries[e].value, "constraint " + model_.constraints.back().name);
        const NodeId base = two_sided[e] ? base_of_power(model_.tape, f) : f;
        if (base != f) {
          model_.bases.push_back(static_cast<Index>(model_.f.size()));
          model_.constraints.back().read_as = written(model_.tape, base, model_.coordinates) + " = 0";
        }
        model_.f.push_back(base);
      }
    }
  }

  void read_energies() {
    const Scope scope{&model_.names, Vocabulary::system, {}};
    kinetic_ = parse_expression(model_.sources.add(text_.kinetic, "kinetic"), scope);
    model_.kinetic = expansion_.node(kinetic_, {});
    if (text_.potential) {
      const Code potential = parse_expression(model_.sources.add(*text_.potential, "potential"), scope);
      model_.potential = expansion_.node(potential, {});
      refuse_velocities(model_.potential, potential, "potential");
    }
    const Assignment forces =
        assign_to_coordinates(text_.forces, "forces", "force on ", model_.names,
                              meanings_.coordinate_families, Vocabulary::system, model_.sources, expansion_);
    model_.forces.assign(model_.coordinates.size(), no_node);
    for (const Family& family : meanings_.coordinate_families)
      for (std::uint32_t m = 0; m < family.members.size(); ++m)
        if (const std::uint32_t entry = forces.entry_of[family.first + m]; entry != no_entry)
          model_.forces[family.first + m] = expansion_.node(forces.entries[entry].value, family.members[m]);
  }

  void refuse_velocities(NodeId node, const Code& code, const std::string& name) const {
    if ((model_.tape.depends(node) & on_velocities) == 0) return;
    NodeId velocity = node;  // any of them
    while (model_.tape.operation(velocity) != Operation::velocity) {
      const NodeId a = model_.tape.a(velocity);
      velocity = (model_.tape.depends(a) & on_velocities) != 0 ? a : model_.tape.b(velocity);
    }
    const auto prime = std::find_if(code.steps.begin(), code.steps.end(), [](const Instruction& i) {
      return i.step == Instruction::Step::differentiate;
    });
    const std::size_t offset = prime == code.steps.end() ? 0 : prime->offset;
    throw convex::InvalidInput(name + ": it depends on the velocity " +
                                   quoted(model_.coordinates[model_.tape.a(velocity)] + "'") +
                                   "; it may depend on coordinates and t only",
                               code.source->text.at(offset));
  }

  void check_dependence() {
    degrees_ = velocity_degrees(model_.tape, model_.kinetic);
    if (degrees_.offending == no_node) return;
    throw convex::InvalidInput("kinetic: T is not quadratic in the velocities, see " +
                                   quoted(written(model_.tape, degrees_.offending, model_.coordinates)) +
                                   "; T must be a polynomial of degree at most 2 in them",
                               model_.sources.place(model_.tape.origin(degrees_.offending)));
  }

  void build_programs() {
    std::vector<NodeId> energies{model_.kinetic}, forces;
    if (model_.potential != no_node) energies.push_back(model_.potential);
    for (std::size_t i = 0; i < model_.forces.size(); ++i) {
      if (model_.forces[i] == no_node) continue;
      forces.push_back(model_.forces[i]);
      model_.forced.push_back(static_cast<Index>(i));
    }
    const std::size_t n = model_.coordinates.size();
    model_.motion = Program(model_.tape, n, {energies, forces});
    model_.hessian = VelocityHessian(model_.tape, model_.motion, degrees_);
    model_.contacts = Program(model_.tape, n, {model_.f});
    Values& largest = model_.largest_summand_of_constant;
    largest.assign(model_.contacts.begin(), 0);
    for (Slot slot = model_.contacts.time() + 1; slot < model_.contacts.begin(); ++slot)
      largest[slot] = largest_summand(model_.contacts.node(slot));
  }

  double largest_summand(NodeId constant) const {
    const Tape& tape = model_.tape;
    double largest = 0;
    std::vector<NodeId> open{constant};
    std::unordered_set<NodeId> seen;
    while (!open.empty()) {
      const NodeId node = open.back();
      open.pop_back();
      if (!seen.insert(node).second) continue;
      const Operation operation = tape.operation(node);
      const bool is_sum = operation == Operation::add || operation == Operation::subtract;
      if (is_sum || operation == Operation::negate) open.push_back(tape.a(node));
      if (is_sum) open.push_back(tape.b(node));
      if (!is_sum && operation != Operation::negate)
        largest = std::max(largest, std::abs(tape.constant(node)));
    }
    return largest;
  }

  const LagrangianText& text_;
  LagrangianModel& model_;
  Vocabularies& meanings_;
  Expansion expansion_;
  std::vector<const Source*> coordinate_keys_, definition_keys_, constraint_keys_;
  std::vector<Group> definition_groups_, constraint_groups_;
  Code kinetic_;
  Degrees degrees_;
};

}  // namespace

std::unique_ptr<const LagrangianModel> read_lagrangian(const LagrangianText& text) {
  auto model = std::make_unique<LagrangianModel>();
  Reading(text, *model).read();
  return model;
}

void gather_mistakes(const LagrangianText& text, const StateText& state, convex::Mistakes& mistakes) {
  LagrangianModel model;
  Reading(text, model).gather_mistakes(state, mistakes);
}

}  // namespace mechanics::expression
