// One number that says whether two builds compute the same runs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gauntlet::worker {

// Hash over whole RunResults of every built-in controller in a few short fixed cases, and over a probe of our
// own trigonometry and random numbers. Equal on every machine and for every compiler; a worker says it in its
// hello, and a campaign refuses workers with another one. Takes some ten milliseconds.
std::uint64_t GoldenHash();

// Names of the controllers that it covers, which a worker says in its hello too: a master that was built with
// others can then say which.
std::vector<std::string> ControllerNames();

}  // namespace gauntlet::worker
