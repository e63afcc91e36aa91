# Reading arms from URDF files: optional, with tinyxml2.
if(CABLEFIT_URDF)  # AUTO as well
  pkg_check_modules(tinyxml2 IMPORTED_TARGET tinyxml2>=9)
endif()
if(tinyxml2_FOUND)
  target_link_libraries(cablefit PRIVATE PkgConfig::tinyxml2)
  set_property(SOURCE ${PROJECT_SOURCE_DIR}/lib/cablefit/model/arm/urdf_file.cpp
               APPEND PROPERTY COMPILE_DEFINITIONS CABLEFIT_URDF)
elseif(CABLEFIT_URDF STREQUAL AUTO)
  message(STATUS "No tinyxml2: built without reading URDF files (Debian: libtinyxml2-dev)")
elseif(CABLEFIT_URDF)
  message(FATAL_ERROR "CABLEFIT_URDF needs tinyxml2 (Debian: libtinyxml2-dev)")
endif()
