// Of a small ARGoS project: loop functions that count the robots that arrive.
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>

#include <fstream>

using namespace argos;

// Counts the robots beyond a line, and writes how many there are each second.
class CrossingLoop : public CLoopFunctions {
 public:
  void Init(TConfigurationNode& node) override {
    GetNodeAttribute(node, "line", line_);
    std::string output;
    GetNodeAttribute(node, "output", output);
    out_.open(output);
    out_ << "clock,arrived\n";
  }

  void PostStep() override {
    if (GetSpace().GetSimulationClock() % 10 == 0) out_ << GetSpace().GetSimulationClock() << "," << Arrived() << "\n";
  }

  void PostExperiment() override { LOG << "arrived: " << Arrived() << " robots" << std::endl; }

 private:
  int Arrived() {
    int arrived = 0;
    for (auto& robot : GetSpace().GetEntitiesByType("foot-bot")) {
      const auto& body = any_cast<CFootBotEntity*>(robot.second)->GetEmbodiedEntity();
      if (body.GetOriginAnchor().Position.GetX() > line_) ++arrived;
    }
    return arrived;
  }

  Real line_ = 0.0;  // m
  std::ofstream out_;
};
REGISTER_LOOP_FUNCTIONS(CrossingLoop, "crossing_loop")
