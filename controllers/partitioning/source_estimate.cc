#include "controllers/partitioning/source_estimate.h"

#include <cmath>

#include "sim/geometry/trigonometry.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {
namespace {

constexpr double kGapFactor = 2.0;
constexpr double kWayFactor = 0.010 / 0.008;  // m counted per m driven, both per tick

// Inverse of the distribution function 1 - exp(-x^2 / (2 scale^2)).
double DrawRayleigh(double scale, sim::RandomStream& random) {
  return scale * std::sqrt(-2.0 * sim::Log(1.0 - random.Uniform()));
}

}  // namespace

void SourceEstimate::Begin(double nest_bearing, sim::RandomStream& random) {
  exact_ = value_ = sim::Vec2::Zero();
  if (drift_ == 0.0) return;
  from_nest_ = -sim::UnitVector(nest_bearing);
  way_ = 0.0;
  share_ = DrawRayleigh(drift_, random);
}

void SourceEstimate::Move(const BodyMotion& motion, bool travelling) {
  exact_ = AfterMotion(exact_, motion);
  value_ = exact_;
  if (drift_ == 0.0) return;
  from_nest_ = AfterMotion(from_nest_, {sim::Vec2::Zero(), motion.turn});
  if (travelling) way_ += std::sqrt(motion.shift.dot(motion.shift));
  value_ += Error();
}

// The end of an arc less the end of the straight way of the same length, seen along from_nest_.
sim::Vec2 SourceEstimate::Error() const {
  const double way = kWayFactor * way_;
  const double turn = share_ * way / sim::foot_bot::kWheelDistance;
  if (turn == 0.0) return sim::Vec2::Zero();
  const sim::SinCos arc = sim::SineCosine(turn);
  const double ahead = kGapFactor * way * (arc.sin / turn - 1.0);
  const double left = kGapFactor * way * (1.0 - arc.cos) / turn;
  return {ahead * from_nest_.x() - left * from_nest_.y(), ahead * from_nest_.y() + left * from_nest_.x()};
}

}  // namespace gauntlet::controllers
