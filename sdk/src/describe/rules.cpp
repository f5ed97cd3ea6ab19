#include "describe/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace relievo {

namespace {

bool is_set(std::string_view subject) {
  return subject == "maps" || subject == "features";
}

bool has_any(const std::set<std::string>& facts, const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return facts.contains(word); });
}

bool has_all(const std::set<std::string>& facts, const std::vector<std::string>& words) {
  return std::all_of(words.begin(), words.end(), [&](const std::string& word) { return facts.contains(word); });
}

bool applies(const Rule& rule, const Facts& facts) {
  return std::all_of(rule.when.begin(), rule.when.end(), [&](const Condition& condition) {
    const auto found = facts.find(condition.subject);
    return found != facts.end() && has_any(found->second, condition.words);
  });
}

std::string text_of(const Condition& condition) {
  return fmt::format("{} = {}", condition.subject,
                     fmt::join(condition.words, is_set(condition.subject) ? " and " : " or "));
}

}  // namespace

const std::vector<std::string>& built_in_subjects() {
  static const std::vector<std::string> subjects = {"technique", "stage",  "address", "filter",  "aov",
                                                    "count",     "target", "maps",    "features"};
  return subjects;
}

bool is_broken(const Rule& rule, const Facts& facts) {
  const auto subject = facts.find(rule.then.subject);
  if (subject == facts.end() || !applies(rule, facts)) return false;
  if (rule.excludes) return has_any(subject->second, rule.then.words);
  return is_set(rule.then.subject) ? !has_all(subject->second, rule.then.words)
                                   : !has_any(subject->second, rule.then.words);
}

std::string to_string(const Rule& rule) {
  std::vector<std::string> when;
  for (const Condition& condition : rule.when) when.push_back(text_of(condition));
  std::string text = when.empty() ? "every permutation" : fmt::format("{}", fmt::join(when, " with "));
  text += fmt::format(" {} {}", rule.excludes ? "excludes" : "requires", text_of(rule.then));
  return rule.reason.empty() ? text : fmt::format("{}: {}", text, rule.reason);
}

std::vector<Condition> read_conditions(TomlReader& table, std::string_view key, const std::string& owner) {
  const std::vector<std::string>& built_in = built_in_subjects();
  std::vector<Condition> conditions;
  for (auto& [subject, words] : table.word_lists(key)) {
    const bool is_own = !owner.empty() && subject.find('.') == std::string::npos &&
                        std::find(built_in.begin(), built_in.end(), subject) == built_in.end();
    conditions.push_back({is_own ? owner + "." + subject : subject, std::move(words)});
  }
  return conditions;
}

std::vector<Rule> read_rules(TomlReader& table, const std::vector<Condition>& when, const std::string& owner) {
  const std::string reason = table.text_or("reason", "");
  std::vector<Rule> rules;
  for (const auto& [key, excludes] : {std::pair("requires", false), std::pair("excludes", true)}) {
    for (Condition& condition : read_conditions(table, key, owner)) {
      rules.push_back({when, std::move(condition), excludes, reason, table.file(), table.line()});
    }
  }
  if (rules.empty()) {
    table.report("describe.missing-key",
                 fmt::format("the {} says nothing; \"requires\" or \"excludes\" is expected", table.label()), "");
  }
  return rules;
}

}  // namespace relievo
