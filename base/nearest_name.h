// Names that a user wrote: whether they are good, what they mean in a table, and of an unknown one the known
// name nearest to it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace gauntlet {

// Whether it can name a campaign, a controller, a scenario, a parameter or a metric: 1 to 64 letters, digits
// and . _ -, not beginning with . or -.
inline constexpr std::size_t kMostNameBytes = 64;
inline bool IsName(std::string_view name) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  return !name.empty() && name.size() <= kMostNameBytes && name.front() != '.' && name.front() != '-' &&
         name.find_first_not_of(kLetters) == std::string_view::npos;
}

// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b` (optimal string
// alignment distance).
inline std::size_t EditDistance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> before_last(width);
  std::vector<std::size_t> last(width);
  std::vector<std::size_t> row(width);
  for (std::size_t j = 0; j < width; ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j < width; ++j) {
      const std::size_t substitution = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

// The known name with the smallest edit distance, the earlier one on ties; "" when none is near. Near: at
// most a third of the longer name's characters differ (but one always may, unless that is the whole name), or
// the unknown name of at least three characters is the beginning or the end of exactly the returned one.
inline std::string NearestName(std::string_view unknown, std::span<const std::string_view> known) {
  std::string_view best;
  std::size_t best_distance = std::string_view::npos;
  for (const std::string_view name : known) {
    const std::size_t distance = EditDistance(unknown, name);
    const std::size_t longer = std::max(unknown.size(), name.size());
    const bool near = distance <= std::max<std::size_t>(1, longer / 3) && distance < longer;
    if (near && distance < best_distance) {
      best = name;
      best_distance = distance;
    }
  }
  if (best.empty() && unknown.size() >= 3) {
    for (const std::string_view name : known) {
      if (!name.starts_with(unknown) && !name.ends_with(unknown)) continue;
      if (!best.empty()) return {};
      best = name;
    }
  }
  return std::string(best);
}

// Of an entry of a table: what it is called, the path of a key; a table of nothing but names is one too.
template <typename Info>
std::string_view NameIn(const Info& info) {
  if constexpr (std::is_convertible_v<const Info&, std::string_view>) {
    return info;
  } else if constexpr (requires { info.name; }) {
    return info.name;
  } else {
    return info.path;
  }
}

// The entry of a table that has this name; nullptr when there is none. The table outlives the answer.
template <typename Infos>
auto FindByName(const Infos& infos, std::string_view name) {
  const auto found =
      std::find_if(infos.begin(), infos.end(), [&](const auto& info) { return NameIn(info) == name; });
  return found == infos.end() ? nullptr : &*found;
}

// "a, b, c": the names of a table.
template <typename Infos>
std::string NamesOf(const Infos& infos) {
  std::string names;
  for (const auto& info : infos) names.append(names.empty() ? "" : ", ").append(NameIn(info));
  return names;
}

// "unknown scenario 'floking'; did you mean 'flocking'?", or with all names that there are.
template <typename Infos>
std::string UnknownName(std::string_view what, std::string_view name, const Infos& infos) {
  std::vector<std::string_view> known;
  for (const auto& info : infos) known.push_back(NameIn(info));
  const std::string nearest = NearestName(name, known);
  std::string message = "unknown ";
  message.append(what).append(" '").append(name).append("'; ");
  if (nearest.empty()) return message.append("known: ").append(NamesOf(infos));
  return message.append("did you mean '").append(nearest).append("'?");
}

}  // namespace gauntlet
