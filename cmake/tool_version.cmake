# Writes a C++ file that tells one version of the compiler from another: a hash over the sources in LIST, and LIBRARIES.
file(STRINGS ${LIST} files)
set(hashes "")
foreach(file IN LISTS files)
  file(SHA256 ${file} hash)
  string(APPEND hashes ${hash})
endforeach()
string(SHA256 hash "${hashes}")
file(WRITE ${OUTPUT} "#include \"relievo/permute.hpp\"

namespace relievo {

std::string_view compiler_version() {
  return \"${LIBRARIES}, sources ${hash}\";
}

}  // namespace relievo
")
