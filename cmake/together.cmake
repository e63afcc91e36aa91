# Where files use the same templates (Eigen's decompositions, options of CLI11), those of a folder that
# begin with neighbouring letters are compiled together: the templates once, not once a file. Names in
# their anonymous namespaces have to differ then.
function(cablefit_together target folder)
  foreach(letters a-f g-o p-z)
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/[${letters}]*.cpp)
    set_source_files_properties(${sources} PROPERTIES UNITY_GROUP "${folder}/${letters}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # Said of types that no other file knows, once their file is included by another.
  target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
endfunction()

foreach(folder design dynamic dynamic/output_error elastic estimate identify refine)
  cablefit_together(cablefit lib/cablefit/${folder})
endforeach()
cablefit_together(cablefit_program apps/commands)
