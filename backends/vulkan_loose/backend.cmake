# It is the Vulkan backend with other programs.
if(NOT EXISTS ${CMAKE_CURRENT_LIST_DIR}/../vulkan)
  message(FATAL_ERROR "backends/vulkan_loose needs backends/vulkan; expected that folder, or neither")
endif()
