#include "c_api/boundary.hpp"
#include "relievo/permute.hpp"

namespace {

/// "relievo 0.1.0, SPIRV-Cross …" begins with the project's own.
const std::string& library_version() {
  static const std::string version = [] {
    const std::string text(relievo::compiler_version());
    const std::size_t begin = text.find(' ') + 1;
    return text.substr(begin, text.find(',') - begin);
  }();
  return version;
}

}  // namespace

relievo_string relievo_version(void) {
  return relievo::c_api::view(library_version());
}

relievo_string relievo_compiler_version(void) {
  return relievo::c_api::view(relievo::compiler_version());
}
