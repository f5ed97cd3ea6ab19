/// Linked into the programs that are run to look for leaks. What a driver sets up once stays reachable only as long as
/// the driver is loaded, and the stack of a leak can be named only as long as the code is there; so nothing is
/// unloaded.
#include <dlfcn.h>

extern "C" {

int dlclose(void*) {
  return 0;
}

/// Mesa 22.3's software Vulkan compiles a shader anew when a uniform that branches depend on has another value, and
/// forgets the one before. What we might forget is looked for by the validation layer (VulkanObjects).
const char* __lsan_default_suppressions() {
  return "leak:libvulkan_lvp.so\n";
}

const char* __lsan_default_options() {
  return "print_suppressions=0";
}
}
