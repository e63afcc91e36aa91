# Files that use the same templates (Eigen's expressions, options of CLI11, JSON) are compiled together:
# the templates once, not once a file. Names in their anonymous namespaces have to differ then. A group
# takes about half a minute.
function(cablefit_together target group)  # then patterns of files
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/)
  file(GLOB sources CONFIGURE_DEPENDS ${ARGN})
  set_source_files_properties(${sources} PROPERTIES UNITY_GROUP ${group})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # gcc then collects its garbage only from 512 MB on. This saves a tenth of the time of large files.
  target_compile_options(${target} PRIVATE
                         $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)
  # Said of types that no other file knows, once their file is included by another.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# Rooms of a folder of the library; "." are its own files.
function(cablefit_folder_together target group folder)
  list(TRANSFORM ARGN REPLACE "(.+)" "lib/cablefit/${folder}/\\1/*.cpp")
  cablefit_together(${target} ${group} ${ARGN})
endfunction()

# Files of a folder that begin with neighbouring letters, e.g. a-f: of tests, whose helpers often have
# the same names.
function(cablefit_letters_together target folder)
  foreach(letters ${ARGN})
    cablefit_together(${target} ${folder}/${letters} ${folder}/[${letters}]*.cpp)
  endforeach()
endfunction()

cablefit_folder_together(cablefit refine refine . rig_errors bases)
cablefit_folder_together(cablefit refine_rows refine rows null search)
cablefit_folder_together(cablefit refine_verdict refine steps verdict figures)
cablefit_folder_together(cablefit dynamic_output_error dynamic output_error)
cablefit_folder_together(cablefit dynamic dynamic . checks estimates)
cablefit_folder_together(cablefit dynamic_rows dynamic rows loops estimators)
cablefit_folder_together(cablefit model model . effects file rig)
# Rows of one table have functions of the same names: those of some tables stay alone.
cablefit_together(cablefit model_arm lib/cablefit/model/arm/[abrs]*.cpp
                  lib/cablefit/model/arm/urdf_*.cpp)
cablefit_together(cablefit model_catalogue lib/cablefit/model/catalogue/[a-c]*.cpp)
cablefit_folder_together(cablefit elastic elastic . bases checks estimates figures models rows zeros)
cablefit_folder_together(cablefit estimate_fit estimate fit solve)
cablefit_folder_together(cablefit estimate_tests estimate tests spread)
cablefit_folder_together(cablefit identify identify . elongations equations results)
cablefit_folder_together(cablefit design design . curves excitation loads)
cablefit_folder_together(cablefit samples samples . plan rows survey weigh)
cablefit_folder_together(cablefit report report . documents page parts sections writers)
cablefit_folder_together(cablefit results results . read write)
cablefit_folder_together(cablefit campaign campaign . cells compare plan)
cablefit_folder_together(cablefit simulate simulate . sensitivity)
cablefit_folder_together(cablefit log log . json)
cablefit_folder_together(cablefit base base . files json)
cablefit_folder_together(cablefit figure figure .)
cablefit_folder_together(cablefit predict predict .)
cablefit_together(cablefit session lib/cablefit/session/*.cpp lib/cablefit/copies/*.cpp
                  lib/cablefit/prove/*.cpp)
cablefit_together(cablefit_program commands apps/commands/*.cpp)
cablefit_together(cablefit_program options apps/*.cpp apps/options/*.cpp apps/output/*.cpp)
