#include <fmt/format.h>

#include <algorithm>

#include "describe/rules.hpp"
#include "permute/axes.hpp"

namespace relievo {

namespace {

std::string suggestion(const std::string& given, const std::vector<std::string>& known, std::string_view otherwise) {
  const std::string nearest = nearest_name(given, known);
  return nearest.empty() ? fmt::format("{} is expected", otherwise) : fmt::format("did you mean \"{}\"?", nearest);
}

/// The words that a built-in subject may have.
std::vector<std::string> known_words(const Registry& registry, const std::string& subject) {
  std::vector<std::string> words;
  if (subject == "target") {
    for (const Target& target : all_targets()) words.push_back(to_string(target));
  } else if (subject == "maps") {
    for (const auto& [name, map] : registry.maps) words.push_back(name);
  } else if (subject == "features") {
    words.assign(known_features().begin(), known_features().end());
  } else {
    words = known_values(registry, kind_of(subject));
  }
  return words;
}

/// Checks the rules of one manifest.
class RuleChecker {
 public:
  RuleChecker(const Registry& registry, const Manifest& manifest)
      : registry_(registry), manifest_(manifest), parameters_(parameters_of(registry)) {}

  Status check(const Rule& rule) const {
    for (const Condition& condition : rule.when) {
      if (Status status = check(rule, condition); !status) return status;
    }
    return check(rule, rule.then);
  }

 private:
  Status check(const Rule& rule, const Condition& condition) const {
    const std::vector<std::string>& built_in = built_in_subjects();
    const std::string& subject = condition.subject;
    const bool is_built_in = std::find(built_in.begin(), built_in.end(), subject) != built_in.end();
    if (is_built_in || kind_of(subject) == AxisKind::role)
      return check_words(rule, condition, known_words(registry_, subject));
    const auto owned = std::find_if(parameters_.begin(), parameters_.end(),
                                    [&](const OwnedParameter& one) { return one.name == subject; });
    if (owned == parameters_.end()) return unknown_subject(rule, subject);
    for (const std::string& word : condition.words) {
      if (const Result<double> value = parse_value(*owned->parameter, word); !value)
        return fail_at(rule, "permute.value", fmt::format("a rule on \"{}\": {}", subject, value.error().message));
    }
    return {};
  }

  Status check_words(const Rule& rule, const Condition& condition, const std::vector<std::string>& known) const {
    for (const std::string& word : condition.words) {
      if (std::find(known.begin(), known.end(), word) != known.end()) continue;
      return fail_at(rule, "permute.value",
                     fmt::format("a rule on \"{}\" names \"{}\"; {}", condition.subject, word,
                                 suggestion(word, known, fmt::format("one of {}", fmt::join(known, ", ")))));
    }
    return {};
  }

  Status unknown_subject(const Rule& rule, const std::string& subject) const {
    std::vector<std::string> known = built_in_subjects();
    for (const OwnedParameter& owned : parameters_) known.push_back(owned.name);
    return fail_at(rule, "permute.unknown-subject",
                   fmt::format("a rule is on \"{}\", which is unknown; {}", subject,
                               suggestion(subject, known,
                                          fmt::format("one of {} or a parameter such as \"relief.linear_steps\"",
                                                      fmt::join(built_in_subjects(), ", ")))));
  }

  tl::unexpected<Error> fail_at(const Rule& rule, std::string id, std::string message) const {
    return fail(ErrorCode::descriptor, std::move(id), std::move(message), manifest_.file, rule.line, 1);
  }

  const Registry& registry_;
  const Manifest& manifest_;
  const std::vector<OwnedParameter> parameters_;
};

}  // namespace

Status check_rules(const Registry& registry, const Manifest& manifest) {
  const RuleChecker checker(registry, manifest);
  for (const Rule& rule : manifest.rules) {
    if (Status status = checker.check(rule); !status) return status;
  }
  return {};
}

}  // namespace relievo
