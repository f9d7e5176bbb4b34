// Controllers that misbehave, for any scenario; `chatty`, `printing` and `counting` do not.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include "sdk/plugin.h"

namespace {

namespace sim = gauntlet::sim;
namespace controllers = gauntlet::controllers;
using controllers::ControllerContext;
using controllers::ControllerFactory;
using controllers::ControllerInfo;

struct Settings {
  int tick = 0;  // in which it happens
};

// What a robot does in the tick.
void Crash() {
  volatile int* nowhere = nullptr;
  *nowhere = 1;
}
void Exit() {
  std::exit(0);
}
void ExitThree() {
  std::exit(3);
}
void Terminate() {
  kill(getpid(), SIGTERM);
}
void KillItself() {
  kill(getpid(), SIGKILL);
}
void CloseAll() {
  for (int file = 0; file < 1024; ++file) close(file);
}
void LimitFiles() {
  constexpr rlimit kOneByte{.rlim_cur = 1, .rlim_max = 1};
  setrlimit(RLIMIT_FSIZE, &kOneByte);
}
void Spin() {
  for (volatile bool on = true; on;) continue;
}
void Allocate() {
  std::vector<std::vector<char>> blocks;
  while (true) blocks.emplace_back(1 << 20, 'x');
}
void Throw() {
  throw std::runtime_error("tired of walking");
}
void ThrowInThread() {
  std::thread([] { throw std::runtime_error("lost in a thread"); }).join();
}
void Talk() {
  std::cout << "on stdout\n";
  std::cerr << "on stderr\n";
  std::ofstream("notes.txt") << "in a file\n";
}
void Print() {
  std::printf("without the end of a line");
}
void Nothing() {}

class Robot : public sim::Controller {
 public:
  Robot(void (*act)(), int tick) : act_(act), tick_(tick) {}
  sim::DeviceSet Devices() const override { return sim::Device::kWheels; }
  void Step(const sim::ControlStep& step) override {
    step.actuators.Drive(0.05, step.random.Uniform(-1.0, 1.0));
    if (step.tick == tick_) act_();
  }

 private:
  void (*act_)();
  int tick_;
};

const controllers::ParameterTable<Settings>& Table() {
  static const controllers::ParameterTable<Settings> table(
      {{"tick", "", 5, 0, 100, controllers::Into<&Settings::tick>(), "in which it happens"}});
  return table;
}

template <void (*kAct)()>
ControllerInfo Row(const char* name) {
  return controllers::ControllerRow(
      name, controllers::kAnyScenario, "misbehaves in one tick", Table(), +[](const Settings& settings) {
        return ControllerFactory{
            [settings](const ControllerContext&) { return std::make_unique<Robot>(kAct, settings.tick); }};
      });
}

// Throws where the robot is made, or its factory.
ControllerInfo RowThatThrows(const char* name, bool in_factory) {
  ControllerInfo row = Row<Nothing>(name);
  row.make = [in_factory](const sim::Parameters&) -> ControllerFactory {
    if (in_factory) throw std::runtime_error("no factory today");
    return {[](const ControllerContext&) -> std::unique_ptr<sim::Controller> {
      throw std::runtime_error("no robot today");
    }};
  };
  return row;
}

// Drives as fast as the time tells it, in whole seconds.
class ClockedRobot : public sim::Controller {
 public:
  sim::DeviceSet Devices() const override { return sim::Device::kWheels; }
  void Step(const sim::ControlStep& step) override { step.actuators.Drive(speed_, speed_); }

 private:
  double speed_ = 1e-4 * static_cast<double>(std::time(nullptr) % 1000);
};

ControllerInfo ClockedRow() {
  ControllerInfo row = Row<Nothing>("clocked");
  row.make = [](const sim::Parameters&) -> ControllerFactory {
    return {[](const ControllerContext&) { return std::make_unique<ClockedRobot>(); }};
  };
  return row;
}

// The robots of a run are counted by one static.
int robots = 0;

ControllerInfo CountingRow() {
  ControllerInfo row = Row<Nothing>("counting");
  row.make = [](const sim::Parameters&) -> ControllerFactory {
    return {[](const ControllerContext& context) {
      if (robots++ != context.robot) throw std::runtime_error("statics of another run");
      return std::make_unique<Robot>(Nothing, 0);
    }};
  };
  return row;
}

std::vector<ControllerInfo> Rows() {
  return {Row<Crash>("crash"),
          Row<Exit>("exit"),
          Row<ExitThree>("exit-three"),
          Row<Terminate>("terminate"),
          Row<KillItself>("kill-itself"),
          Row<CloseAll>("close-all"),
          Row<LimitFiles>("limit-files"),
          Row<Spin>("spin"),
          Row<Allocate>("allocate"),
          Row<Throw>("throw"),
          Row<ThrowInThread>("throw-in-thread"),
          Row<Talk>("chatty"),
          Row<Print>("printing"),
          RowThatThrows("throw-in-factory", true),
          RowThatThrows("throw-in-constructor", false),
          CountingRow(),
          ClockedRow()};
}

}  // namespace

GAUNTLET_PLUGIN(Rows)
