#include "game_controller/rules/rules.hpp"

namespace counterpart {

const Rules* find_rules(std::string_view name) {
  for (const Rules* rules : {&international_rules, &brazilian_rules, &english_rules}) {
    if (rules->name == name) return rules;
  }
  return nullptr;
}

}  // namespace counterpart
