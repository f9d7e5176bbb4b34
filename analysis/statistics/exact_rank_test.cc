// The exact distribution of U with ties, by dynamic programming over the groups of equal values.
#include <algorithm>
#include <cmath>

#include "analysis/statistics/rank_test.h"
#include "base/check.h"

namespace gauntlet::analysis {
namespace {

struct Tails {
  double at_most = 0.0;  // chance of at most the observed U
  double equal = 0.0;    // of exactly it
};

// `groups`: how many values share each rank, in the order in which values are counted as "before". `picked`
// of them all are dealt to one set; U2 is twice the number of pairs in which one of the other set comes
// before one of this set, ties counting half. Chances of U2 <= `observed`.
Tails Distribution(const std::vector<std::size_t>& groups, std::size_t picked, std::size_t observed) {
  // ways[j][u]: in how many ways j of the values so far give u. With kMostExactPairs they stay far below the
  // largest double (200 choose 100 is 9e58).
  std::vector<std::vector<double>> ways(picked + 1, std::vector<double>(observed + 1, 0.0));
  ways[0][0] = 1.0;
  double all = 1.0;  // ways to deal them, whatever U
  std::size_t before = 0;
  for (const std::size_t tied : groups) {
    for (std::size_t j = std::min(picked, before + tied); j > 0; --j) {
      double choices = 1.0;  // `taken` of `tied`
      for (std::size_t taken = 1; taken <= std::min(tied, j); ++taken) {
        choices *= static_cast<double>(tied - taken + 1) / static_cast<double>(taken);
        const std::size_t had = j - taken;
        if (had > before) continue;
        const std::size_t added = 2 * taken * (before - had) + taken * (tied - taken);
        const std::size_t reachable = std::min(observed, added + 2 * had * (before - had));
        for (std::size_t u = added; u <= reachable; ++u) ways[j][u] += choices * ways[had][u - added];
      }
    }
    before += tied;
  }
  for (std::size_t i = 1; i <= picked; ++i) {
    all *= static_cast<double>(before - picked + i) / static_cast<double>(i);
  }
  Tails tails;
  for (const double count : ways[picked]) tails.at_most += count / all;
  tails.equal = ways[picked][observed] / all;
  return tails;
}

}  // namespace

std::optional<ExactRankTest> ExactMannWhitney(std::span<const double> first, std::span<const double> second) {
  GAUNTLET_CHECK(!first.empty() && !second.empty(), "a rank test needs values in both sets");
  if (first.size() > kMostExactPairs / second.size()) return std::nullopt;
  std::vector<double> all(first.begin(), first.end());
  all.insert(all.end(), second.begin(), second.end());
  std::sort(all.begin(), all.end());
  std::vector<std::size_t> groups;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0 && all[i] == all[i - 1]) {
      ++groups.back();
    } else {
      groups.push_back(1);
    }
  }
  // The smaller set is followed, and the smaller tail: both keep the table small, and the tail that may be
  // tiny is summed, not got by a difference.
  const RankTest test = MannWhitney(first, second);
  const bool first_is_less = test.u1 <= test.u2;
  const bool follows_first = first.size() <= second.size();
  if (first_is_less != follows_first) std::reverse(groups.begin(), groups.end());
  const Tails tails = Distribution(groups, std::min(first.size(), second.size()),
                                   static_cast<std::size_t>(std::lround(2.0 * std::min(test.u1, test.u2))));
  const double smaller = std::min(1.0, tails.at_most);
  const double larger = std::clamp(1.0 - tails.at_most + tails.equal, 0.0, 1.0);

  ExactRankTest exact;
  exact.method = "Mann-Whitney U, exact distribution of the observed mid-ranks";
  exact.p_less = first_is_less ? smaller : larger;
  exact.p_greater = first_is_less ? larger : smaller;
  exact.p_two_sided = std::min(1.0, 2.0 * std::min(smaller, larger));
  return exact;
}

}  // namespace gauntlet::analysis
