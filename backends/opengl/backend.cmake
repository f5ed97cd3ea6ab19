target_link_libraries(relievo PRIVATE PkgConfig::epoxy ${CMAKE_DL_LIBS})
