# gauntlet_add_argos_plugin(NAME SOURCES FILE... [TABLE FILE]): the shared library libNAME.so of controllers that were written
# for ARGoS. The sources are compiled as they are, without warnings. TABLE is what `gauntlet build-controller --table` makes of an
# .argos file; without it the controllers get no parameters.
function(gauntlet_add_argos_plugin name)
  cmake_parse_arguments(PARSE_ARGV 1 plugin "" "TABLE" "SOURCES")
  if(NOT plugin_SOURCES OR plugin_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "gauntlet_add_argos_plugin(${ARGV}): write gauntlet_add_argos_plugin(NAME SOURCES FILE... [TABLE FILE])")
  endif()
  if(NOT plugin_TABLE)
    set(plugin_TABLE ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/plugin_main.cc)
  endif()
  gauntlet_add_plugin(${name} SOURCES ${plugin_SOURCES} ${plugin_TABLE})
  target_link_libraries(${name} PRIVATE Gauntlet::gauntlet_argos)
  target_compile_options(${name} PRIVATE -w -fpermissive)
endfunction()
