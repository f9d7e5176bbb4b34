// Parameters as a tree of elements with attributes. A node is a handle: copies stand for the same element.
#pragma once

#include <cassert>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

// The value of a text; false when it is none. Bytes are numbers, truth is `true` or `false`, a text is all of
// itself, everything else is what `>>` reads.
template <typename T>
bool ReadText(const std::string& text, T& value) {
  std::istringstream stream(text);
  stream >> value;
  return !stream.fail();
}
bool ReadText(const std::string& text, std::string& value);
bool ReadText(const std::string& text, bool& value);
bool ReadText(const std::string& text, UInt8& value);
bool ReadText(const std::string& text, SInt8& value);

class TConfigurationNode {
 public:
  explicit TConfigurationNode(const std::string& tag = "");

  const std::string& Value() const;  // its tag
  const std::string& GetText() const;
  void SetText(const std::string& text);
  bool NoChildren() const { return Children().empty(); }

  // Of an attribute that is not there: null.
  const std::string* FindAttribute(const std::string& name) const;
  bool HasAttribute(const std::string& name) const { return FindAttribute(name) != nullptr; }
  void SetAttributeText(const std::string& name, const std::string& value);
  template <typename T>
  void SetAttribute(const std::string& name, const T& value) {
    SetAttributeText(name, ToString(value));
  }
  // These throw when it is not there or is no such value.
  const std::string& GetAttribute(const std::string& name) const;
  template <typename T>
  void GetAttribute(const std::string& name, T* value) const {
    if (!ReadText(GetAttribute(name), *value)) {
      throw CARGoSException("Attribute \"" + name + "\" of <" + Value() + "> is \"" + GetAttribute(name) +
                            "\", which is no value of its type");
    }
  }
  template <typename T, typename U>
  void GetAttributeOrDefault(const std::string& name, T* value, const U& other) const {
    *value = other;
    if (HasAttribute(name)) GetAttribute(name, value);
  }

  // Children keep their place: references to them stay valid as long as the tree. Null when there is none.
  TConfigurationNode* FindChild(const std::string& tag = "") const;
  TConfigurationNode* FirstChildElement(const std::string& tag = "") const;  // throws when there is none
  TConfigurationNode* FirstChild(const std::string& tag = "") const { return FirstChildElement(tag); }
  TConfigurationNode& AddChild(const TConfigurationNode& child);
  const std::vector<std::unique_ptr<TConfigurationNode>>& Children() const;

 private:
  struct Element;
  std::shared_ptr<Element> element_;
};

// Walks the children of a node, all of them or those with a tag:
// `for (it = it.begin(&node); it != it.end(); ++it)`.
class TConfigurationNodeIterator {
 public:
  explicit TConfigurationNodeIterator(const std::string& tag = "") : tag_(tag) {}

  TConfigurationNodeIterator begin(const TConfigurationNode* parent) const {
    TConfigurationNodeIterator first(tag_);
    first.parent_ = *parent;
    first.Skip();
    return first;
  }
  TConfigurationNodeIterator end() const { return TConfigurationNodeIterator(tag_); }
  TConfigurationNode& operator*() const { return *Get(); }
  TConfigurationNode* operator->() const { return Get(); }
  TConfigurationNode* Get() const {
    return index_ < parent_.Children().size() ? parent_.Children()[index_].get() : nullptr;
  }
  TConfigurationNodeIterator& operator++() {
    ++index_;
    Skip();
    return *this;
  }
  TConfigurationNodeIterator operator++(int) {
    const TConfigurationNodeIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const TConfigurationNodeIterator& other) const { return Get() == other.Get(); }

 private:
  void Skip() {
    while (Get() != nullptr && !tag_.empty() && Get()->Value() != tag_) ++index_;
  }

  std::string tag_;
  TConfigurationNode parent_;
  std::size_t index_ = 0;
};

inline bool NodeExists(const TConfigurationNode& node, const std::string& tag) {
  return node.FindChild(tag) != nullptr;
}
inline TConfigurationNode& GetNode(const TConfigurationNode& node, const std::string& tag) {
  return *node.FirstChildElement(tag);
}
inline void AddChildNode(TConfigurationNode& parent, const TConfigurationNode& child) {
  parent.AddChild(child);
}

inline bool NodeAttributeExists(const TConfigurationNode& node, const std::string& name) {
  return node.HasAttribute(name);
}
template <typename T>
void GetNodeAttribute(const TConfigurationNode& node, const std::string& name, T& value) {
  node.GetAttribute(name, &value);
}
template <typename T>
void GetNodeAttributeOrDefault(const TConfigurationNode& node, const std::string& name, T& value,
                               const T& other) {
  node.GetAttributeOrDefault(name, &value, other);
}
template <typename T>
void SetNodeAttribute(TConfigurationNode& node, const std::string& name, const T& value) {
  node.SetAttribute(name, value);
}

template <typename T>
void GetNodeText(const TConfigurationNode& node, T& value) {
  if (!ReadText(node.GetText(), value)) {
    throw CARGoSException("The text of <" + node.Value() + "> is no value of its type");
  }
}
template <typename T>
void GetNodeTextOrDefault(const TConfigurationNode& node, T& value, const T& other) {
  value = other;
  if (!node.GetText().empty()) GetNodeText(node, value);
}

}  // namespace argos

// The name of the library that ARGoS reads XML with, which a few sources use.
namespace ticpp {
using Element = argos::TConfigurationNode;
// A whole file; reading one is left to Init's parameters.
class Document {};
template <typename Node>
using Iterator = argos::TConfigurationNodeIterator;
}  // namespace ticpp
