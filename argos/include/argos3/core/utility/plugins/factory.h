// Classes that are created by a label.
#pragma once

#include <iostream>
#include <map>
#include <set>
#include <string>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

template <typename Type>
class CFactory {
 public:
  using Creator = Type* (*)();
  using TTypeMap = std::map<std::string, Creator>;

  // At file scope: what a source brings is there as soon as its library is loaded.
  struct CRegistration {
    CRegistration(const std::string& label, Creator creator) { Register(label, creator); }
  };

  // Of two with the same label the later one counts, and the label is one of GetRepeatedLabels().
  static void Register(const std::string& label, Creator creator) {
    if (!GetTypeMap().insert_or_assign(label, creator).second) GetTypes().repeated.insert(label);
  }
  static bool Exists(const std::string& label) { return GetTypeMap().count(label) > 0; }
  // The caller's to delete. Throws when nothing has that label.
  static Type* New(const std::string& label) {
    const auto found = GetTypeMap().find(label);
    if (found == GetTypeMap().end()) throw CARGoSException("Nothing is registered as \"" + label + "\"");
    return found->second();
  }
  static TTypeMap& GetTypeMap() { return GetTypes().map; }
  static const std::set<std::string>& GetRepeatedLabels() { return GetTypes().repeated; }

 private:
  // A std::map of strings itself would get a symbol of which g++ and clang have different names
  // ([abi:cxx11]).
  struct Types {
    TTypeMap map;
    std::set<std::string> repeated;
  };
  static Types& GetTypes() {
    static Types types;
    return types;
  }
};

}  // namespace argos
