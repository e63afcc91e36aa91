# The HTML report: plotly.js, pinned by a lock file, is fetched by npm into the build folder and goes
# into the library with the page's own files.
find_program(CABLEFIT_NPM npm)
if(NOT CABLEFIT_NPM)
  message(FATAL_ERROR "The HTML report takes plotly.js from npm, which is not here. Install npm "
                      "(Debian: apt-get install --no-install-recommends npm), or build without the "
                      "report: -DCABLEFIT_PAGE=OFF")
endif()

set(page_source ${PROJECT_SOURCE_DIR}/lib/cablefit/report/page)
set(page_build ${PROJECT_BINARY_DIR}/page)
set(plotly ${page_build}/node_modules/plotly.js-basic-dist-min/plotly-basic.min.js)
add_custom_command(OUTPUT ${plotly}
  COMMAND ${CMAKE_COMMAND} -E copy ${page_source}/package.json ${page_source}/package-lock.json
          ${page_build}/
  COMMAND ${CABLEFIT_NPM} ci --prefer-offline --ignore-scripts --no-audit --no-fund
          --loglevel=error
  COMMAND ${CMAKE_COMMAND} -E touch ${plotly}  # newer than the lock file, which npm leaves older
  DEPENDS ${page_source}/package.json ${page_source}/package-lock.json
  WORKING_DIRECTORY ${page_build}
  COMMENT "Fetching plotly.js with npm" VERBATIM)
file(MAKE_DIRECTORY ${page_build})

set(embedding ${PROJECT_SOURCE_DIR}/lib/cablefit/report/page/page_parts.cpp)
set_property(SOURCE ${embedding} APPEND PROPERTY COMPILE_DEFINITIONS
  CABLEFIT_PAGE_FOLDER="${page_source}" CABLEFIT_PLOTLY_FILE="${plotly}")
set_property(SOURCE ${embedding} APPEND PROPERTY OBJECT_DEPENDS
  "${plotly};${page_source}/page.html;${page_source}/page.css;${page_source}/page.js")
