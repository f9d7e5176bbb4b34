// What a study is: campaigns of searches and re-simulations, what is computed from them, and the published
// figures to hold against that. Read from TOML files; nothing of a particular study is in code.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

// Searches of one kind, which differ in nothing but their seeds.
struct StudyPart {
  enum class Kind {
    kEvolve,    // the experiment's search, once for each seed
    kRandom,    // random cases
    kEmpty,     // the arena without obstacles
    kEvaluate,  // cases of another part once more, with fresh seeds
  };
  std::string name;
  Kind kind = Kind::kEvolve;
  std::string where;  // "FILE:LINE:COLUMN", for messages
  Experiment experiment;
  std::vector<std::uint64_t> seeds;
  std::string from;    // of kEvaluate: the part that the cases come from,
  std::string subset;  // and which of them, as ParseSubset takes it
  std::string group;   // parts of a tuning, which are many, are told together; "" = alone
};

// A parameter of a search, which is changed while all others keep their values.
struct TunedValue {
  std::string value;  // as --set takes it
  std::string part;   // its evolutions
};
struct TunedParameter {
  std::string key;  // "search.population"
  std::string baseline;
  std::vector<TunedValue> values;  // with the baseline's
};
struct Tuning {
  std::string title;
  std::string experiment;
  int repeats = 0;                 // evolutions of each value
  std::uint64_t budget = 0;        // runs of each evolution, which set its generations; 0 = none
  std::vector<std::size_t> sizes;  // of the sets of the consistency analysis, ascending
  std::string baseline_part;
  std::vector<TunedParameter> parameters;
};
// The part in which the final populations of a tuning's part are simulated again.
std::string AgainPart(const std::string& part);

// What of a study is other than its file says; "" and empty: nothing.
struct TuningChanges {
  std::string experiment;
  std::string repeats;             // as it was typed
  std::vector<std::string> sets;   // "key=value", of every part that does not say otherwise
  std::vector<std::string> tries;  // "key=a,b,c": the candidates, instead of the file's
  std::string budget;              // as it was typed: runs of each evolution, which set its generations

  bool operator==(const TuningChanges&) const = default;
};

// A table of a study's file as it is written, "[compare.NAME]".
struct StudyFileTable {
  struct Entry {
    std::string key;
    std::string value;
    std::string where;
  };
  std::string kind;
  std::string name;
  std::string where;           // "FILE:LINE:COLUMN", for messages
  std::vector<Entry> entries;  // in the order of the file; "set.KEY" is a key

  bool Has(const std::string& key) const { return Find(key) != nullptr; }
  std::string Key(const std::string& key) const;  // "" when it was not given
  std::string PlaceOf(const std::string& key) const;
  // What stands below "set" or the like: keys without it, and their values.
  std::vector<std::pair<std::string, std::string>> Nested(const std::string& key) const;
  // The same as --set takes it.
  std::vector<std::string> Sets() const;

 private:
  const Entry* Find(const std::string& key) const;
};

// Something that is computed from the runs of parts. Which keys there are depends on the kind; all that are
// needed are there.
struct StudyAnalysis : StudyFileTable {  // of the kind "compare", "count", "types", "peak", "windows", "tune"
  std::optional<Tuning> tuning;          // of the kind "tune"
};

// A remark to a published figure.
struct PublishedNote {
  std::string text;     // "" = none
  bool always = false;  // else only where ours differs
};

// A figure that was published, and how ours is judged against it.
struct PublishedRow {
  std::string section;
  std::string quantity;
  std::string condition;
  std::string value;
  std::string figure;  // ours, "ANALYSIS.FIGURE"; "" = we compute none
  std::string rule;    // as Judge takes it; "" = not judged
  PublishedNote note;
};

struct Study {
  std::string name;
  std::string description;
  std::vector<StudyPart> parts;
  std::vector<StudyAnalysis> analyses;
  std::vector<PublishedRow> published;
  // Every file that it was read from, by its name without folders; two studies with the same texts are one.
  std::map<std::string, std::string> texts;
  std::string main_file;
  TuningChanges changes;
  std::vector<std::string> plugins;  // SHA-256 of those that bring controllers of its parts
};

// A shipped study by its name, or a file by its path (with a '/' or ending in ".toml"). Files that it
// includes or takes published figures from stand beside it. Errors begin with the place and name what would
// be right. Published figures of a tuning are left out when more than its repeats is changed: they are of
// another one. `plugins`: the SHA-256 of those that may bring controllers, which are known; those that the
// files of its experiments name (PluginFilesOf) are made known and taken, too.
Result<Study> LoadStudy(const std::string& name_or_path, const TuningChanges& changes = {},
                        const std::vector<std::string>& plugins = {});
// The same of texts that were read before.
Result<Study> ReadStudy(const std::map<std::string, std::string>& texts, const std::string& main_file,
                        const TuningChanges& changes = {}, const std::vector<std::string>& plugins = {});

// One of the sets that an analysis names, "PART:SUBSET".
struct StudySet {
  std::string part;
  std::string subset;
};
// "PART[:SUBSET]", several with commas in between.
std::vector<StudySet> SplitStudySets(const std::string& text);

// The names of shipped studies.
std::vector<std::string> ShippedStudies();

}  // namespace gauntlet
