# Warnings are errors in our own code; sanitizers and coverage come from the presets.
add_library(relievo_flags INTERFACE)
target_compile_options(relievo_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 sees overlaps in std::string's operator+ that are not there (GCC PR 105651).
  target_compile_options(relievo_flags INTERFACE -Wno-restrict)
endif()
if(RELIEVO_SANITIZE)
  add_compile_options(-fsanitize=${RELIEVO_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${RELIEVO_SANITIZE})
  # The packaged glslang has no run-time type information, which this one check needs to link.
  if(RELIEVO_SANITIZE MATCHES undefined)
    add_compile_options(-fno-sanitize=vptr)
  endif()
endif()
if(RELIEVO_COVERAGE)
  add_compile_options(--coverage -O0)
  add_link_options(--coverage)
endif()
