# The pure function RunSpec -> RunResult, without anything of processes and sockets.
add_library(gauntlet_run STATIC golden_hash.cc run_executor.cc)
target_link_libraries(gauntlet_run PUBLIC gauntlet_sim gauntlet_controllers gauntlet_options)
