// A question about cases: a row says what is asked of them and what the answers say. Its command, help, text,
// JSON and place on pages follow from the row (question_table.h has all of them).
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/tables/section.h"
#include "base/result.h"
#include "master/campaign/campaign_summary.h"
#include "study/questions/case_answer.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {

// What somebody asks, as it was typed.
struct Asking {
  // The campaign that the cases are of, the corpus, or a call of Question::other that is told again.
  std::string place;
  std::vector<std::string> cases;  // that are named: runs by their numbers, and files
  std::map<std::string, std::vector<std::string>, std::less<>> options =
      {};                      // by name; of a flag without values
  Experiment experiment = {};  // that a new campaign is of
  // Of Question::sweeps: all that are swept, `experiment` the first; each with what tells it from the others.
  std::vector<SearchPlan> experiments = {};
  std::optional<Experiment> other = {};  // that it is held against (Question::other)
  std::string program = "gauntlet";      // how commands begin
  std::function<void(const std::string& message)> say = [](const std::string&) {};
  bool quiet = false;  // says only what is wrong

  bool Has(std::string_view option) const { return options.contains(option); }
  std::string Value(std::string_view option) const;  // "" when it was not given
  std::vector<std::string> Values(std::string_view option) const;
};
// `otherwise` when the option was not given. Error: it is no whole number of the range.
Result<int> WholeNumber(const Asking& asking, std::string_view option, int low, int high, int otherwise);

struct QuestionOption {
  enum class Kind {
    kFlag,
    kValue,
    kValues,   // one value each time that it is given
    kFiles,    // several values behind it
    kPlugins,  // libraries
    kOutput,   // a file to be written
  };
  const char* name;  // "--replicates"
  const char* type;  // "N", how the help calls its value
  const char* help;
  Kind kind = Kind::kValue;
  const char* sets = "";  // the key of a new campaign's experiment that the value is for
};

// A call of a question.
struct Call {
  std::string directory = {};                // of its campaign: empty, or what an earlier such call has left
  std::vector<SearchPlan> searches = {};     // without cases when nothing has to be simulated
  std::vector<CaseAnswer> cases = {};        // that were asked about, in their order; nothing is known yet
  bool anew = false;                         // what an earlier call has ended with makes room
  const CampaignSummary* summary = nullptr;  // of its campaign, once it was simulated

  bool Simulates() const;
};

struct KeptFile {
  std::string path;
  std::string content;
  std::string what;       // it is, for people; "" = they are not told
  bool replaces = false;  // else what is there already stays
};

enum class Conclusion { kDone, kNegative, kRefused };

// What the answers say.
struct Told {
  Section section = {};
  std::string json = {};
  std::string details = {};  // text below the section, as it is
  std::vector<KeptFile> files = {};
  std::map<std::string, std::string> outputs = {};  // by the option that names the file
  std::vector<std::string> messages = {};
  Conclusion conclusion = Conclusion::kDone;
};

struct Question {
  enum class Place {
    kCampaign,     // DIR CASE...; its calls are kept in DIR/name, and what is known is not simulated again
    kCorpus,       // CORPUS; its calls are kept in CORPUS/.name
    kNewCampaign,  // EXPERIMENT; each call is a campaign wherever the user says
  };
  enum class Named { kAny, kSome, kOne, kNone };

  const char* name;     // of the command
  const char* summary;  // one line of help
  const char* help;     // below the options
  Place place = Place::kCampaign;
  Named named = Named::kSome;                // how many cases are named
  const char* other = "";                    // help of a second experiment; "" = there is none
  bool streams = false;                      // its cases may also come line by line (cli/stream_run.h)
  bool sweeps = false;                       // a new campaign may have several searches, --sweep and --seeds
  std::vector<QuestionOption> options = {};  // beside those of all questions
  // The cases that are meant. Of kCampaign, as what follows.
  Result<QuestionedCampaign> (*cases)(const Asking& asking) = nullptr;  // nullptr: those that are named
  // An experiment that asks about cases of another one.
  Result<Experiment> (*about)(const Experiment& experiment, const Asking& asking) = nullptr;
  // What is asked in another way is kept apart under this name; nullptr, "": it is not.
  std::string (*variant)(const Asking& asking) = nullptr;
  CaseKey key = KeyOfCase;
  // Whether an answer under this key is enough; nullptr: any is.
  bool (*enough)(const CaseAnswer& answer, const Asking& asking) = nullptr;
  // Of other places: what is to be simulated.
  Result<Call> (*plan)(const Asking& asking) = nullptr;
  // Of the cases in the order of the call. Those of kCampaign are decided.
  Result<Told> (*tell)(const Asking& asking, const Call& call, std::span<const CaseAnswer> answers) = nullptr;
  bool looks_at_empty_arena = false;  // first, unless that is known (baselines.h)
  const char* page_title = "";        // of its section on the page of a case; "" = pages tell it elsewhere
};

// The cases that are named. Error: also that one of them has no obstacle.
Result<QuestionedCampaign> CasesWithObstacles(const Asking& asking);
// Where the calls of a question are kept. `variant`: Question::variant of what is asked.
std::string FolderOf(const Question& question, const std::string& place, const std::string& variant = "");
// Error: a case or an option is refused.
Result<Call> PlanCall(const Question& question, const Asking& asking);
// What is known by now of the cases of a call, under the names that it gives them; of kCampaign those that
// are decided.
Result<std::vector<CaseAnswer>> AnswersTo(const Question& question, const Asking& asking, const Call& call);

// What the question says of a case of the campaign that was asked about, for pages.
struct ToldCase {
  RunId run = 0;
  Section section;
};
// Of all of them; none when pages tell it elsewhere.
Result<std::vector<ToldCase>> ToldCases(const Question& question, const std::string& dir);

}  // namespace gauntlet
