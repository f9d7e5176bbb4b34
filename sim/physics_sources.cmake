# Physics, sensors, robot and the simulation loop; included by sim/CMakeLists.txt, which defines gauntlet_sim.
target_sources(
  gauntlet_sim
  PRIVATE observer.cc
          physics/box2d_engine.cc
          physics/differential_drive.cc
          physics/nearby_boxes.cc
          physics/neighbour_pairs.cc
          physics/relaxation_engine.cc
          robot/controller.cc
          robot/devices.cc
          robot/disturbances.cc
          robot/obstacle_course.cc
          run_checks.cc
          run_result.cc
          sensors/distance_scanner.cc
          sensors/disturber.cc
          sensors/light_sensor.cc
          sensors/neighbour_grid.cc
          sensors/occluders.cc
          sensors/omni_camera.cc
          sensors/proximity.cc
          sensors/range_and_bearing.cc
          sensors/robot_pairs.cc
          sensors/sensor_suite.cc
          simulation.cc)
target_link_libraries(gauntlet_sim PRIVATE box2d::box2d)
