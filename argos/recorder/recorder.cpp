// A visualization for ARGoS3 that shows nothing: it steps the experiment and writes down where the robots are.
// `gauntlet adopt` compiles it against the ARGoS that is installed; in an experiment's file:
//
//   <visualization><gauntlet_recorder file="trajectory.csv" every="1"/></visualization>
//
// file:  CSV with the columns time (s), robot, kind, x, y (m), heading (rad), of every controllable entity. It
//        stands there under this name when the experiment has ended well, and not before. Where GAUNTLET_REPLAY is in
//        the environment, there is also a file with ".replay" after this name and rows of every tick.
// every: s between rows of a robot; 0 = every tick. The first and the last tick have rows in any case.
// world: a file that tells what stands in the arena at the beginning and which libraries are loaded, with tabs:
//        "robot" or "body", id, kind, movable (0 or 1), x, y (m), smallest and largest x, then y, of its bounding box;
//        "library", its path without links, the path by which it was loaded. Without the attribute there is none.
#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/entity/controllable_entity.h>
#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/simulator/physics_engine/physics_engine.h>
#include <argos3/core/simulator/space/space.h>
#include <argos3/core/simulator/visualization/visualization.h>
#include <argos3/core/utility/logging/argos_log.h>

#include <link.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

using argos::CARGoSException;  // which ARGoS' macros name without their namespace

namespace {

// Names in a row of a CSV file.
std::string Plain(std::string text) {
  for (char& c : text) {
    if (c == ',' || c == '"' || c == '\t' || c == '\n' || c == '\r') c = '_';
  }
  return text;
}

std::FILE* OpenToWrite(const std::string& path) {
  std::FILE* const file = std::fopen(path.c_str(), "w");
  if (file == NULL) THROW_ARGOSEXCEPTION("gauntlet_recorder cannot write " << path);
  return file;
}

// Also tells that the disk is full.
void Close(std::FILE* file, const std::string& path) {
  const bool whole = std::ferror(file) == 0;
  if (std::fclose(file) != 0 || !whole) THROW_ARGOSEXCEPTION("gauntlet_recorder cannot write " << path);
}

int WriteLibrary(dl_phdr_info* info, std::size_t, void* file) {
  if (info->dlpi_name == NULL || info->dlpi_name[0] == '\0') return 0;
  char* const path = realpath(info->dlpi_name, NULL);
  if (path != NULL) std::fprintf(static_cast<std::FILE*>(file), "library\t%s\t%s\n", path, info->dlpi_name);
  std::free(path);
  return 0;
}

// A file of poses, which has its name when it is whole.
class Poses {
 public:
  Poses(const std::string& path, argos::Real every)
      : path_(path), draft_(path + ".draft"), file_(OpenToWrite(draft_)), every_(every), next_(0.0) {
    std::fprintf(file_, "time,robot,kind,x,y,heading\n");
  }

  bool IsDue(argos::Real now) const { return now + 1e-9 >= next_; }
  void WroteAt(argos::Real now) { next_ = now + every_; }
  std::FILE* file() const { return file_; }

  void Finish() {
    Close(file_, draft_);
    if (std::rename(draft_.c_str(), path_.c_str()) != 0)
      THROW_ARGOSEXCEPTION("gauntlet_recorder cannot write " << path_);
  }

 private:
  std::string path_;
  std::string draft_;
  std::FILE* file_;
  argos::Real every_;
  argos::Real next_;  // s, when poses are written again
};

}  // namespace

class GauntletRecorder : public argos::CVisualization {
 public:
  GauntletRecorder() : every_(1.0) {}

  virtual void Init(argos::TConfigurationNode& node) {
    argos::GetNodeAttribute(node, "file", path_);
    argos::GetNodeAttributeOrDefault(node, "every", every_, every_);
    argos::GetNodeAttributeOrDefault(node, "world", world_, world_);
  }
  virtual void Reset() {}
  virtual void Destroy() {}

  virtual void Execute() {
    if (!world_.empty()) {
      WriteWorld();
      argos::LOG << "gauntlet: the experiment begins" << std::endl;
    }
    files_.push_back(Poses(path_, every_));
    if (std::getenv("GAUNTLET_REPLAY") != NULL) files_.push_back(Poses(path_ + ".replay", 0.0));
    WritePoses();
    while (!m_cSimulator.IsExperimentFinished()) {
      m_cSimulator.UpdateSpace();
      WritePoses();
    }
    m_cSimulator.GetLoopFunctions().PostExperiment();
    argos::LOG.Flush();
    argos::LOGERR.Flush();
    for (std::size_t i = 0; i < files_.size(); ++i) files_[i].Finish();
  }

 private:
  argos::Real Now() const {
    return m_cSpace.GetSimulationClock() * argos::CPhysicsEngine::GetSimulationClockTick();
  }

  // Of a type of which there may be none, for which ARGoS throws.
  const argos::CSpace::TMapPerType& EntitiesOf(const std::string& type) {
    static const argos::CSpace::TMapPerType none;
    const argos::CSpace::TMapPerTypePerId& all = m_cSpace.GetEntityMapPerTypePerId();
    const argos::CSpace::TMapPerTypePerId::const_iterator found = all.find(type);
    return found == all.end() ? none : found->second;
  }

  // Of the robot that a controller drives; NULL of what has no body, which is nowhere.
  static const argos::CEmbodiedEntity* BodyOf(argos::CEntity& root) {
    argos::CComposableEntity* const robot = dynamic_cast<argos::CComposableEntity*>(&root);
    if (robot == NULL || !robot->HasComponent("body")) return NULL;
    return &robot->GetComponent<argos::CEmbodiedEntity>("body");
  }

  void WritePoses() {
    for (std::size_t i = 0; i < files_.size(); ++i) {
      if (!files_[i].IsDue(Now()) && !m_cSimulator.IsExperimentFinished()) continue;
      WritePosesTo(files_[i].file());
      files_[i].WroteAt(Now());
    }
  }

  void WritePosesTo(std::FILE* file) {
    const argos::CSpace::TMapPerType& robots = EntitiesOf("controller");
    argos::CSpace::TMapPerType::const_iterator one;
    for (one = robots.begin(); one != robots.end(); ++one) {
      argos::CEntity& root = argos::any_cast<argos::CControllableEntity*>(one->second)->GetRootEntity();
      const argos::CEmbodiedEntity* const body = BodyOf(root);
      if (body == NULL) continue;
      const argos::SAnchor& anchor = body->GetOriginAnchor();
      argos::CRadians z, y, x;
      anchor.Orientation.ToEulerAngles(z, y, x);
      std::fprintf(file, "%.17g,%s,%s,%.17g,%.17g,%.17g\n", static_cast<double>(Now()),
                   Plain(root.GetId()).c_str(), Plain(root.GetTypeDescription()).c_str(),
                   static_cast<double>(anchor.Position.GetX()), static_cast<double>(anchor.Position.GetY()),
                   static_cast<double>(z.GetValue()));
    }
  }

  void WriteWorld() {
    std::FILE* const file = OpenToWrite(world_);
    const argos::CSpace::TMapPerType& bodies = EntitiesOf("body");
    argos::CSpace::TMapPerType::const_iterator one;
    for (one = bodies.begin(); one != bodies.end(); ++one) {
      argos::CEmbodiedEntity& body = *argos::any_cast<argos::CEmbodiedEntity*>(one->second);
      argos::CEntity& root = body.GetRootEntity();
      argos::CComposableEntity* const whole = dynamic_cast<argos::CComposableEntity*>(&root);
      const bool robot = whole != NULL && whole->HasComponent("controller");
      const argos::SBoundingBox& box = body.GetBoundingBox();
      const argos::CVector3& place = body.GetOriginAnchor().Position;
      std::fprintf(file, "%s\t%s\t%s\t%d\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\t%.17g\n", robot ? "robot" : "body",
                   Plain(root.GetId()).c_str(), Plain(root.GetTypeDescription()).c_str(), body.IsMovable() ? 1 : 0,
                   static_cast<double>(place.GetX()), static_cast<double>(place.GetY()),
                   static_cast<double>(box.MinCorner.GetX()), static_cast<double>(box.MaxCorner.GetX()),
                   static_cast<double>(box.MinCorner.GetY()), static_cast<double>(box.MaxCorner.GetY()));
    }
    dl_iterate_phdr(WriteLibrary, file);
    Close(file, world_);
  }

  std::string path_;
  std::string world_;
  argos::Real every_;
  std::vector<Poses> files_;
};

REGISTER_VISUALIZATION(GauntletRecorder, "gauntlet_recorder", "Gauntlet", "1.0", "Records where the robots are.",
                       "Steps the experiment and writes the robots' poses to a CSV file.", "Usable")
