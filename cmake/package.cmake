# The Debian package: cpack -G DEB. It holds what runs (program, manual pages, completion, schemas and
# example logs, documentation); headers and library are for those who build from source.
find_program(CABLEFIT_GZIP gzip)
if(NOT CABLEFIT_GZIP)
  message(STATUS "No gzip: no Debian package")
  return()
endif()

set(CPACK_PACKAGE_NAME cablefit)
set(CPACK_PACKAGE_VENDOR "the cablefit authors")
set(CPACK_PACKAGE_CONTACT "the cablefit authors <cablefit@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "identification of cable-driven robot transmissions from logs")
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
    "Fits stiffness, inertia and friction of cable-driven joints to logs of
positions and torques, with standard deviations. It identifies the physical
effect that a model lacks.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME cablefit)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

# What Debian asks of every package: its licence and a changelog of its own form.
set(debian_folder ${PROJECT_BINARY_DIR}/debian)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS LICENSE CHANGELOG.md)
if(CABLEFIT_PAGE)
  string(APPEND license
         "\nHTML reports contain plotly.js, Copyright Plotly, Inc., under the MIT licence.\n")
endif()
file(WRITE ${debian_folder}/copyright "cablefit\n\n${license}")
execute_process(COMMAND ${CABLEFIT_GZIP} -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md
                OUTPUT_FILE ${debian_folder}/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${debian_folder}/changelog.Debian
     "cablefit (${PROJECT_VERSION}-1) unstable; urgency=low\n\n  * See changelog.gz.\n\n"
     " -- ${CPACK_PACKAGE_CONTACT}  ${now}\n")
execute_process(COMMAND ${CABLEFIT_GZIP} -9nf ${debian_folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${debian_folder}/copyright ${debian_folder}/changelog.gz
              ${debian_folder}/changelog.Debian.gz
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
include(CPack)
