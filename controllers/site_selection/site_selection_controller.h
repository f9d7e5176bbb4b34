// A robot that decides with its swarm for the better of two sites, by direct modulation of majority-based
// decisions (Valentini, Ferrante, Hamann and Dorigo 2016): it explores the site of its opinion, tells its
// opinion in the nest for a time in proportion to the site's quality, then takes the opinion of the majority.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/proximity.h"
#include "controllers/common/random_walk.h"
#include "controllers/common/steering.h"
#include "sim/robot/controller.h"

namespace gauntlet::controllers::site_selection {

// A is the one towards the light.
enum class Site : std::uint8_t { kA, kB };
// kGo: to the site of the opinion. kBack: to the nest.
enum class SiteState : std::uint8_t { kGo, kSurvey, kBack, kTell };

// What a robot says over the radio.
struct SiteMessage {
  SiteState state = SiteState::kGo;
  Site opinion = Site::kA;
  bool aloud = false;       // robots count it as an opinion told; otherwise only the scenario reads it
  std::uint8_t sender = 0;  // number of the robot, up to 255
};
sim::Payload Encode(const SiteMessage& message);
// Nothing of a robot that says nothing.
std::optional<SiteMessage> DecodeSiteMessage(const sim::Payload& payload);

// Greys of the floor (chosen): white where nothing is, then the nest, then sites, the darker the better.
inline constexpr double kNestGrey = 0.7;
inline double GreyOf(double quality) {
  return 0.5 * (1.0 - quality);
}  // of a site; quality in [0, 1]

struct SiteSelectionSettings {
  double speed = 0.0;          // m/s
  double survey_time = 0.0;    // s, mean
  double tell_time = 0.0;      // s, mean for quality 1
  double tell_chance = 0.0;    // per tick in kTell, to tell the opinion aloud
  int group = 0;               // opinions of so many others, those heard last, count
  sim::Tick listen_ticks = 0;  // at the end of kTell
  sim::Tick patience = 0;      // robots that avoided for so long make a detour; 0 = never
  sim::Tick detour_ticks = 0;
};

// One robot. Knows the light's direction, the grey of the floor under it, what is near, and what others tell.
// Not for sharing between threads.
class SiteSelectionController : public sim::Controller {
 public:
  // Robots with an even number begin with opinion A, the others with B; all in kGo.
  SiteSelectionController(const SiteSelectionSettings& settings, const ControllerContext& context);

  sim::DeviceSet Devices() const override;
  sim::DeviceSet Attention(bool holding_item) const override;
  void Begin(sim::Actuators& actuators) override;
  void Step(const sim::ControlStep& step) override;

  SiteState state() const { return state_; }
  Site opinion() const { return opinion_; }
  bool on_detour() const { return detour_left_ > 0; }

 private:
  bool Listens() const { return state_ == SiteState::kTell && left_ <= settings_.listen_ticks; }
  bool Travels() const { return state_ == SiteState::kGo || state_ == SiteState::kBack; }
  void ChangeState(const sim::ControlStep& step);
  void Hear(std::span<const sim::Message> messages);
  Site Majority(sim::RandomStream& random) const;
  DriveCommand Move(const sim::ControlStep& step);
  // 1 = towards the light, -1 = away from it, 0 = wherever the random walk leads.
  double AlongLight(const sim::SensorReadings& readings, const sim::Vec2& light);
  void KeepPatience(bool avoids, sim::RandomStream& random);
  DriveCommand FollowObstacle(const ProximitySum& near) const;

  SiteSelectionSettings settings_;
  std::uint8_t number_;
  RandomWalk walk_;
  SiteState state_ = SiteState::kGo;
  Site opinion_;
  double quality_ = 0.0;            // of the site that was explored last
  sim::Tick left_ = 0;              // in kSurvey and kTell
  bool strayed_ = false;            // off the site in kSurvey, off the nest in kTell
  double home_ = 0.0;               // AlongLight back to the nest, 0 = not known
  std::vector<SiteMessage> heard_;  // one of each sender, the latest last
  sim::Tick held_ = 0;              // ticks with avoidance less those without
  sim::Tick detour_left_ = 0;
  double side_ = 1.0;  // of a detour: 1 = the obstacle is kept on the right, -1 = on the left
};

}  // namespace gauntlet::controllers::site_selection
