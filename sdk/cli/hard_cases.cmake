# tests/hard_cases/*.toml become part of the program, so that an installed one can judge without the sources.
file(GLOB hard_case_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/hard_cases/*.toml)
list(SORT hard_case_files)
set(hard_case_entries "")
foreach(file IN LISTS hard_case_files)
  file(READ ${file} text)
  get_filename_component(name ${file} NAME)
  string(APPEND hard_case_entries "    {\"tests/hard_cases/${name}\", R\"relievo(${text})relievo\"},\n")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
endforeach()
set(embedded_hard_cases ${PROJECT_BINARY_DIR}/generated/embedded_hard_cases.cpp)
file(CONFIGURE OUTPUT ${embedded_hard_cases} @ONLY CONTENT
"#include <utility>
#include <vector>

namespace relievo::cli {

extern const std::vector<std::pair<const char*, const char*>> embedded_hard_cases;
const std::vector<std::pair<const char*, const char*>> embedded_hard_cases = {
@hard_case_entries@};

}  // namespace relievo::cli
")
