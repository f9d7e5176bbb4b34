# gauntlet_add_plugin(NAME SOURCES FILE...): the shared library libNAME.so, which `gauntlet --plugin` takes. It exports
# nothing but what GAUNTLET_PLUGIN declares (sdk/plugin.h).
function(gauntlet_add_plugin name)
  cmake_parse_arguments(PARSE_ARGV 1 plugin "" "" "SOURCES")
  if(NOT plugin_SOURCES OR plugin_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "gauntlet_add_plugin(${ARGV}): write gauntlet_add_plugin(NAME SOURCES FILE...)")
  endif()
  add_library(${name} MODULE ${plugin_SOURCES})
  target_link_libraries(${name} PRIVATE Gauntlet::gauntlet_sdk)
  target_link_options(${name} PRIVATE -Wl,--exclude-libs,ALL -Wl,--no-undefined -Wl,--gc-sections)
  # Without a definition of its own name, plug-ins can share a precompiled header.
  set_target_properties(${name} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON DEFINE_SYMBOL "")
endfunction()
