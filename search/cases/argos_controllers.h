// The controllers of ARGoS3 experiment files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "sim/run_spec.h"

namespace gauntlet {

// What a robot of the scenario, such as a flock's prey, is given as its controller in files that we write.
inline constexpr const char* kScenarioController = "scenario";

// C++ source of a plug-in's table of controllers that holds every section of <controllers>: tags of devices,
// parameters and ids; of the first foot-bot that has a controller, also how the robots' ids begin and how
// many bytes their messages have. `file_name` stands in messages. Error "FILE:LINE:COLUMN: ..." for malformed
// XML, another root than <argos-configuration>, and no <controllers> with at least one element.
Result<std::string> ArgosControllerTable(const std::string& text, const std::string& file_name);

// Whether an .argos file that parses has loop functions, which Gauntlet does not run.
bool HasLoopFunctions(const std::string& text);

// Controllers for the robots of another file.
struct ArgosControllers {
  std::string sections;  // XML: the elements below <controllers>
  std::string id;        // of the one that the robots under test get
  // As the file's robots with that controller have it; nothing: no robot of the file has it, or says so.
  std::optional<std::string> robots = {};  // what their ids begin with; their numbers follow
  std::optional<int> message_bytes = {};   // rab_data_size
};

// Out of an .argos file, or an XML file whose root is <controllers>. `id` chooses a controller; "" takes the
// only one. Error "FILE:LINE:COLUMN: ..." for malformed XML, no controllers, one that ARGoS would not load
// (without id, <actuators>, <sensors> or <params>), an id that is given twice or is not there, several
// controllers and no `id`.
Result<ArgosControllers> ReadArgosControllers(const std::string& text, const std::string& file_name,
                                              const std::string& id);

// The same with the values of a plug-in's parameters, "flocking.target_distance", where the chosen
// controller's <params> have a number of that path.
ArgosControllers WithParameters(ArgosControllers controllers, const sim::Parameters& parameters);

// Why the chosen controller does not look like the source of a plug-in's `controller` with these parameters,
// "it is a <walker>, and it has no flocking.gain"; "" when it does.
std::string UnlikenessTo(const ArgosControllers& controllers, const std::string& controller,
                         const std::vector<std::string>& parameters);

}  // namespace gauntlet
