# Where files use the same templates (Eigen's expressions, options of CLI11, JSON), those of a folder
# that begin with neighbouring letters are compiled together: the templates once, not once a file. Names
# in their anonymous namespaces have to differ then. FILES: those that the pattern matches; LETTERS: only
# those that begin so.
function(cablefit_together target folder)
  cmake_parse_arguments(PARSE_ARGV 2 only "" "FILES" "LETTERS")
  if(NOT only_FILES)
    set(only_FILES "*.cpp")
  endif()
  if(NOT only_LETTERS)
    set(only_LETTERS a-f g-o p-z)
  endif()
  foreach(letters ${only_LETTERS})
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/[${letters}]${only_FILES})
    set_source_files_properties(${sources} PROPERTIES UNITY_GROUP "${folder}/${letters}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # gcc then collects its garbage only from 512 MB on. This saves a tenth of the time of large files.
  target_compile_options(${target} PRIVATE
                         $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)
  # Said of types that no other file knows, once their file is included by another.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

foreach(folder design design/excitation dynamic/checks dynamic/estimators dynamic/rows elastic
        elastic/figures elastic/models identify/elongations refine/verdict report/documents
        report/sections samples/weigh)
  cablefit_together(cablefit lib/cablefit/${folder})
endforeach()
foreach(folder base base/files campaign campaign/cells campaign/plan copies design/curves design/loads
        dynamic dynamic/estimates dynamic/loops dynamic/output_error elastic/bases elastic/checks
        elastic/estimates elastic/rows elastic/zeros estimate/fit estimate/solve estimate/spread
        estimate/tests identify identify/equations identify/results log/json model model/effects
        model/file model/rig predict prove refine refine/bases refine/figures refine/null
        refine/rig_errors refine/rows refine/search refine/steps report/page report/parts report/writers
        results results/read samples samples/plan samples/rows samples/survey simulate)
  cablefit_together(cablefit lib/cablefit/${folder} LETTERS a-z)
endforeach()
# Rows of one table have functions of the same names.
cablefit_together(cablefit lib/cablefit/model/arm LETTERS a-f r-s t-z)
cablefit_together(cablefit lib/cablefit/model/catalogue LETTERS a-c)
cablefit_together(cablefit lib/cablefit/results/write FILES "*_json.cpp")
cablefit_together(cablefit_program apps/commands)
cablefit_together(cablefit_program apps/options)
cablefit_together(cablefit_program apps/output LETTERS a-z)
