// The obstacles that move and those that carry lights (thesis 7.4), tick by tick.
#pragma once

#include <span>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/robot/surroundings.h"

namespace gauntlet::sim {

class ObstacleCourse {
 public:
  explicit ObstacleCourse(const Arena& arena);

  // Where the centres of the moving obstacles shall be at the end of the coming tick, in the order of
  // Arena::moving(). Each goes along its path and back, at its speed; one that squeezes a robot turns back
  // early. Call once per tick, with the robots as the tick finds them.
  void Advance(std::span<const Pose> robots);
  std::span<const Vec2> centers() const { return centers_; }

  // The moving obstacles as they are now.
  std::span<const OrientedBox> boxes() const { return boxes_; }
  // For the simulation loop: where physics brought obstacle `index`.
  void Place(std::size_t index, const OrientedBox& box);

  // One lamp before the middle of each side of every lit obstacle, at the height of a robot's beacon: nothing
  // but boxes hides it, among them the obstacle itself from those on its other sides.
  std::span<const Light> lights() const { return lights_; }

 private:
  struct Traveller {
    std::vector<Vec2> path;         // m, from where it begins
    std::vector<double> distances;  // m along the path, of its points
    double speed = 0.0;             // m/s
    double travelled = 0.0;         // m along the path
    bool back = false;
    std::size_t first_light = 0;  // of lights_, when lit
    bool lit = false;
  };

  static Vec2 PointAt(const Traveller& traveller, double distance);
  static bool Squeezes(const OrientedBox& box, const Vec2& way, std::span<const Pose> robots);
  void PlaceLights(const OrientedBox& box, std::size_t first_light);

  std::vector<Traveller> travellers_;
  std::vector<Vec2> centers_;
  std::vector<OrientedBox> boxes_;
  std::vector<Light> lights_;
};

}  // namespace gauntlet::sim
