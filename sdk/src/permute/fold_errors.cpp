#include "permute/fold_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace relievo {

namespace {

constexpr std::size_t most_named = 3;

/// The message without the permutation's name, which is in the list.
std::string without_name(std::string message, const std::string& key) {
  for (const std::string& words : {fmt::format(" (permutation '{}')", key), fmt::format(" permutation '{}'", key)}) {
    for (std::size_t at = message.find(words); at != std::string::npos; at = message.find(words)) {
      message.erase(at, words.size());
    }
  }
  return message;
}

auto place_of(const Error& error) {
  return std::tie(error.file, error.line, error.column, error.id, error.message);
}

}  // namespace

void ErrorFolder::add(const Error& error, const std::string& key, const std::string& permutation, std::size_t count) {
  Error common = error;
  common.message = without_name(std::move(common.message), key);
  auto same = std::find_if(folded_.begin(), folded_.end(),
                           [&](const FoldedError& other) { return place_of(other.error) == place_of(common); });
  if (same == folded_.end()) same = folded_.insert(folded_.end(), FoldedError{std::move(common), 0, {}});
  same->count += count;
  same->permutations.push_back(permutation);
  std::sort(same->permutations.begin(), same->permutations.end());
  if (same->permutations.size() > most_named) same->permutations.pop_back();
}

std::vector<FoldedError> ErrorFolder::take() {
  std::sort(folded_.begin(), folded_.end(), [](const FoldedError& a, const FoldedError& b) {
    if (a.count != b.count) return a.count > b.count;
    return place_of(a.error) < place_of(b.error);
  });
  return std::move(folded_);
}

}  // namespace relievo
