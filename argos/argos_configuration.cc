#include <argos3/core/utility/configuration/argos_configuration.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace argos {
namespace {

template <typename Byte>
bool ReadByte(const std::string& text, Byte& value) {
  int number = 0;
  if (!ReadText(text, number)) return false;
  if (number < std::numeric_limits<Byte>::min() || number > std::numeric_limits<Byte>::max()) return false;
  value = static_cast<Byte>(number);
  return true;
}

}  // namespace

bool ReadText(const std::string& text, std::string& value) {
  value = text;
  return true;
}
bool ReadText(const std::string& text, bool& value) {
  value = text == "true";
  return value || text == "false";
}
bool ReadText(const std::string& text, UInt8& value) {
  return ReadByte(text, value);
}
bool ReadText(const std::string& text, SInt8& value) {
  return ReadByte(text, value);
}

struct TConfigurationNode::Element {
  std::string tag;
  std::string text;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<std::unique_ptr<TConfigurationNode>> children;
};

TConfigurationNode::TConfigurationNode(const std::string& tag) : element_(std::make_shared<Element>()) {
  element_->tag = tag;
}

const std::string& TConfigurationNode::Value() const {
  return element_->tag;
}
const std::string& TConfigurationNode::GetText() const {
  return element_->text;
}
void TConfigurationNode::SetText(const std::string& text) {
  element_->text = text;
}

const std::string* TConfigurationNode::FindAttribute(const std::string& name) const {
  for (const auto& [known, value] : element_->attributes) {
    if (known == name) return &value;
  }
  return nullptr;
}

void TConfigurationNode::SetAttributeText(const std::string& name, const std::string& value) {
  for (auto& [known, old] : element_->attributes) {
    if (known == name) {
      old = value;
      return;
    }
  }
  element_->attributes.emplace_back(name, value);
}

const std::string& TConfigurationNode::GetAttribute(const std::string& name) const {
  const std::string* const value = FindAttribute(name);
  if (value == nullptr) throw CARGoSException("<" + Value() + "> has no attribute \"" + name + "\"");
  return *value;
}

TConfigurationNode* TConfigurationNode::FindChild(const std::string& tag) const {
  for (const std::unique_ptr<TConfigurationNode>& child : element_->children) {
    if (tag.empty() || child->Value() == tag) return child.get();
  }
  return nullptr;
}

TConfigurationNode* TConfigurationNode::FirstChildElement(const std::string& tag) const {
  TConfigurationNode* const child = FindChild(tag);
  if (child == nullptr) throw CARGoSException("<" + Value() + "> has no child <" + tag + ">");
  return child;
}

TConfigurationNode& TConfigurationNode::AddChild(const TConfigurationNode& child) {
  return *element_->children.emplace_back(std::make_unique<TConfigurationNode>(child));
}

const std::vector<std::unique_ptr<TConfigurationNode>>& TConfigurationNode::Children() const {
  return element_->children;
}

}  // namespace argos
