// Classes that are created by a label.
#pragma once

#include <iostream>
#include <map>
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

  // The later one of two with the same label counts.
  static void Register(const std::string& label, Creator creator) { GetTypeMap()[label] = creator; }
  static bool Exists(const std::string& label) { return GetTypeMap().count(label) > 0; }
  // The caller's to delete. Throws when nothing has that label.
  static Type* New(const std::string& label) {
    const auto found = GetTypeMap().find(label);
    if (found == GetTypeMap().end()) throw CARGoSException("Nothing is registered as \"" + label + "\"");
    return found->second();
  }
  static TTypeMap& GetTypeMap() {
    static Types types;
    return types.map;
  }

 private:
  // A std::map of strings itself would get a symbol of which g++ and clang have different names
  // ([abi:cxx11]).
  struct Types {
    TTypeMap map;
  };
};

}  // namespace argos
