# Physics, sensors, robot and the simulation loop; included by tests/sim/CMakeLists.txt.
gauntlet_test(
  sim_physics_test
  SOURCES argos_csv.cc
          physics/argos_scenes.cc
          physics/box2d_engine_test.cc
          physics/differential_drive_test.cc
          physics/moving_boxes_test.cc
          physics/nearby_boxes_test.cc
          physics/neighbour_pairs_test.cc
          physics/relaxation_engine_test.cc
  LIBRARIES gauntlet_sim)

gauntlet_test(
  sim_sensors_test
  SOURCES argos_csv.cc
          robot/devices_test.cc
          sensors/box2d_oracle_test.cc
          sensors/ground_sensor_test.cc
          sensors/light_sensor_test.cc
          sensors/omni_camera_test.cc
          sensors/proximity_test.cc
          sensors/range_and_bearing_test.cc
          sensors/robot_pairs_test.cc
          sensors/sensor_suite_test.cc
  LIBRARIES gauntlet_sim box2d::box2d)

gauntlet_test(
  sim_simulation_test
  SOURCES disturbances_test.cc interaction_test.cc moving_obstacles_test.cc observer_test.cc run_result_test.cc simulation_test.cc
  LIBRARIES gauntlet_sim)

# An executable of its own, because it replaces the allocation functions.
gauntlet_test(
  sim_allocation_test
  SOURCES allocation_test.cc
  LIBRARIES gauntlet_sim)
