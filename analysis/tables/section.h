// What is told under one heading: sentences, a table, pictures and commands, as text and as HTML.
#pragma once

#include <string>
#include <vector>

#include "analysis/tables/table.h"

namespace gauntlet {

struct Picture {
  std::string title;
  std::string reading;  // what it shows, a sentence
  std::string svg;
};

struct NextCommand {
  std::string command;
  std::string purpose;  // "see what happened in the toughest case"
};

// Everything is text; what is empty is left out. The order is that in which it is told.
struct Section {
  std::string title = "";
  std::vector<std::string> lead = {};  // sentences above the table
  Table table = {};
  std::vector<std::string> sentences = {};  // below it
  std::vector<Picture> pictures = {};       // on pages only
  std::vector<NextCommand> commands = {};
};

// An empty line first when there is a title; sentences are wrapped and indented like the table.
std::string ToText(const Section& section);
// The title is a heading of the third level.
std::string ToHtml(const Section& section);

}  // namespace gauntlet
