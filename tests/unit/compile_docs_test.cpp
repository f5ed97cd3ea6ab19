/// docs/targets.md repeats the capability table for readers; this keeps the two the same.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "relievo/compile.hpp"
#include "support/sample_programs.hpp"

namespace relievo {
namespace {

/// Cells of "| a | b |", without spaces and backticks.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::string cell;
  for (const char c : line.substr(std::min<std::size_t>(1, line.size()))) {
    if (c == '|') {
      cells.push_back(std::exchange(cell, {}));
    } else if (c != ' ' && c != '`') {
      cell += c;
    }
  }
  return cells;
}

/// Feature → first version in the order GLSL, ESSL, HLSL, MSL, as the page has it.
std::map<std::string, std::vector<std::string>> documented_rows() {
  std::ifstream page(RELIEVO_SOURCE_DIR "/docs/targets.md");
  std::map<std::string, std::vector<std::string>> rows;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    const auto cells = cells_of(line);
    if (cells == std::vector<std::string>{"feature", "GLSL", "ESSL", "HLSL", "MSL"}) {
      inside = true;
    } else if (inside && cells.size() != 5) {
      inside = false;
    } else if (inside && cells[0].find('-') == std::string::npos) {
      rows[cells[0]] = {cells.begin() + 1, cells.end()};
    }
  }
  return rows;
}

bool documented(const std::vector<std::string>& row, const Target& target) {
  if (target.language == Language::spirv) return true;
  const std::string& version = row[static_cast<std::size_t>(target.language) - 1];
  return version == "all" || (version != "never" && target.version >= std::stoi(version));
}

TEST(CompileDocs, TheCapabilityTableOfThePageIsTheOneInTheCode) {
  const auto rows = documented_rows();
  EXPECT_GE(rows.size(), 15U);
  for (const auto& [feature, row] : rows) {
    ComposedProgram program = testing::make_program({{ShaderStage::vertex, "", {}}});
    program.features = {feature};
    for (const Target& target : all_targets()) {
      EXPECT_EQ(check_capabilities(target, program, {}).has_value(), documented(row, target))
          << feature << " on " << to_string(target);
    }
  }
}

TEST(CompileDocs, EveryKnownFeatureHasARow) {
  const auto rows = documented_rows();
  for (const std::string& feature : known_features()) EXPECT_EQ(rows.count(feature), 1U) << feature;
}

}  // namespace
}  // namespace relievo
