# Manual pages, written by help2man from each command's --help, so that they say what the program
# says. Installed where help2man is (Debian: help2man); nothing else needs it.
find_program(CABLEFIT_HELP2MAN help2man)
if(NOT CABLEFIT_HELP2MAN)
  message(STATUS "No help2man: no manual pages")
  return()
endif()

set(man_folder ${PROJECT_BINARY_DIR}/man)
set(man_script ${PROJECT_SOURCE_DIR}/scripts/man-pages)
set(man_pages ${man_folder}/cablefit.1.gz)
add_custom_command(OUTPUT ${man_pages}
  COMMAND ${man_script} --program $<TARGET_FILE:cablefit_program> --out ${man_folder}
          --help2man ${CABLEFIT_HELP2MAN}
  DEPENDS cablefit_program ${man_script}
  COMMENT "Writing manual pages" VERBATIM)
add_custom_target(cablefit_man ALL DEPENDS ${man_pages})
install(DIRECTORY ${man_folder}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime
        FILES_MATCHING PATTERN "*.1.gz")
