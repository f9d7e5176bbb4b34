// Lines that ask for evaluations come by one descriptor, answers go by another: the feed of a stream.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "master/session/evaluation_feed.h"
#include "search/experiment/experiment.h"
#include "study/streams/evaluation_line.h"

namespace gauntlet {

// Only lines that are not answered are kept, and what was not written yet: an answer that was given before is
// read from the store. The descriptors are the caller's, and stay in whatever mode they are: nothing is read
// or written unless it can be done at once.
class EvaluationPipe final : public EvaluationFeed {
 public:
  static constexpr int kProtocol = 1;
  static constexpr std::size_t kLongestLine = 1U << 20;  // bytes

  struct Descriptors {
    int in = 0;
    int out = 1;
  };
  // `directory`: the campaign's, for the greeting.
  EvaluationPipe(const Experiment& experiment, std::string directory, Descriptors descriptors);

  Status Begin(SearchId search, CaseStream& stream, ResultStore& store) override;
  Status Turn(std::size_t window) override;
  void Answer(const EvaluationRequest& request, std::span<const StoredRun* const> runs) override;
  int fd() const override { return input_ended_ || full_ ? -1 : descriptors_.in; }
  std::chrono::milliseconds patience() const override;
  bool Drained() const override { return input_ended_ && unread().empty() && unwritten().empty(); }

  std::uint64_t lines() const { return lines_; }

 private:
  // A case that is not answered, and the lines that wait for it.
  struct Open {
    StoredLine line;
    std::vector<std::uint64_t> asked_by;
  };

  std::string_view unread() const { return std::string_view(input_).substr(taken_); }
  std::string_view unwritten() const { return std::string_view(output_).substr(written_); }
  bool Full(std::size_t window) const;
  // The next line, without its end; false = it is not there yet.
  bool NextLine(std::string& line);
  Status ReadSome();
  Status WriteSome();
  Status Take(std::string_view text);
  Status TakeLine(EvaluationLine line);
  // Of a line that was asked for before: whether it is answered, or waits.
  Status AnswerAgain(const StoredLine& before, const EvaluationLine& line);
  void Say(const nlohmann::ordered_json& json);
  void Complain(LineError wrong);

  const Experiment experiment_;
  const std::string directory_;
  const Descriptors descriptors_;
  EvaluationLineReader reader_;
  SearchId search_ = 0;
  CaseStream* stream_ = nullptr;
  ResultStore* store_ = nullptr;
  RunId next_run_ = 0;

  std::map<IndividualId, Open> open_;
  std::map<std::string, IndividualId, std::less<>> named_;  // of these
  std::size_t waiting_ = 0;                                 // lines that wait for an answer
  std::uint64_t lines_ = 0;                                 // taken

  std::string input_;
  std::size_t taken_ = 0;  // bytes of it
  bool too_long_ = false;  // the line that is being read, whose beginning is dropped
  bool input_ended_ = false;
  bool full_ = false;
  bool more_ = false;  // there is more to take at once
  std::string output_;
  std::size_t written_ = 0;  // bytes of it
};

}  // namespace gauntlet
