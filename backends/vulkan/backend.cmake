# volk is used as one header; it opens the loader at run time, so nothing is linked. Vulkan's structures are filled by
# name and the rest is zero, as the API intends.
target_include_directories(relievo PRIVATE ${VOLK_INCLUDE_DIR})
set_property(SOURCE ${sources} TARGET_DIRECTORY relievo APPEND PROPERTY COMPILE_OPTIONS -Wno-missing-field-initializers)
