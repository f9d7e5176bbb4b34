// A sorted set without duplicates.
#pragma once

#include <cstddef>
#include <functional>
#include <set>

#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

template <typename T, typename Compare = std::less<T>>
class CSet {
 public:
  using iterator = typename std::set<T, Compare>::iterator;
  using const_iterator = typename std::set<T, Compare>::const_iterator;

  iterator begin() const { return values_.begin(); }
  iterator end() const { return values_.end(); }
  bool empty() const { return values_.empty(); }
  std::size_t size() const { return values_.size(); }
  bool exists(const T& value) const { return values_.count(value) > 0; }
  iterator find(const T& value) const { return values_.find(value); }
  const T& first() const { return *values_.begin(); }
  const T& last() const { return *values_.rbegin(); }
  void insert(const T& value) { values_.insert(value); }
  void erase(const T& value) { values_.erase(value); }
  void erase(const iterator& position) { values_.erase(position); }
  void clear() { values_.clear(); }

 private:
  std::set<T, Compare> values_;
};

}  // namespace argos
