#include "study/streams/evaluation_pipe.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "master/campaign/stored_search.h"
#include "master/store/run_numbers.h"

namespace gauntlet {
namespace {

constexpr std::size_t kChunk = 1U << 16;          // bytes read at once
constexpr std::size_t kMostUnwritten = 1U << 20;  // bytes; with more nothing is read
constexpr int kLinesPerTurn = 256;                // then others get their turn

bool ReadyFor(int descriptor, short events) {
  pollfd item{descriptor, events, 0};
  return poll(&item, 1, 0) > 0;
}

// Drops what is done with, seldom enough that it costs little.
void Drop(std::string& buffer, std::size_t& done) {
  if (done < buffer.size() && done < kChunk) return;
  buffer.erase(0, done);
  done = 0;
}

}  // namespace

EvaluationPipe::EvaluationPipe(const Experiment& experiment, std::string directory, Descriptors descriptors)
    : experiment_(experiment),
      directory_(std::move(directory)),
      descriptors_(descriptors),
      reader_(experiment) {}

Status EvaluationPipe::Begin(SearchId search, CaseStream& stream, ResultStore& store) {
  search_ = search;
  stream_ = &stream;
  store_ = &store;
  TRY(const std::optional<SavedState> state, store.LoadNewestState(search));
  next_run_ = state ? state->last_run + 1 : RunIdOf(search, 1);
  TRY(std::vector<StoredLine> lines, store.LoadLines(search, stream.told()));
  TRY(std::vector<Individual> individuals, store.LoadIndividuals(search, stream.told()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    StoredLine& line = lines[i];
    if (i >= individuals.size() || individuals[i].id != line.individual || line.first_run != next_run_)
      return Error{
          ErrorKind::kCorrupt,
          fmt::format("the line of individual {} does not follow from those before it", line.individual)};
    TRY(StreamedCase asked, reader_.Restore(line, std::move(individuals[i].test_case)));
    next_run_ += asked.replicates;
    stream.Add(std::move(asked));
    if (!line.name.empty()) named_[line.name] = line.individual;
    const IndividualId individual = line.individual;
    open_[individual].line = std::move(line);
  }
  Say({{"gauntlet", GAUNTLET_VERSION},
       {"protocol", kProtocol},
       {"experiment", experiment_.name},
       {"directory", directory_},
       {"seed", fmt::format("{}", experiment_.seed)},
       {"replicates", experiment_.search.replicates}});
  return Ok{};
}

bool EvaluationPipe::Full(std::size_t window) const {
  return stream_->open() >= window || waiting_ >= window || unwritten().size() >= kMostUnwritten;
}

Status EvaluationPipe::Turn(std::size_t window) {
  TRY(WriteSome());
  std::string line;
  int taken = 0;
  while (!Full(window) && taken < kLinesPerTurn) {
    if (NextLine(line)) {
      TRY(Take(line));
      ++taken;
    } else if (!input_ended_ && ReadyFor(descriptors_.in, POLLIN)) {
      TRY(ReadSome());
    } else {
      break;
    }
  }
  full_ = Full(window);
  more_ = taken == kLinesPerTurn && !full_;
  if (input_ended_ && unread().empty()) stream_->End();
  return WriteSome();
}

std::chrono::milliseconds EvaluationPipe::patience() const {
  constexpr std::chrono::milliseconds kLong{1000};
  constexpr std::chrono::milliseconds kSoon{10};  // whoever reads has read by then
  if (!unwritten().empty()) return kSoon;
  return more_ ? std::chrono::milliseconds(0) : kLong;
}

bool EvaluationPipe::NextLine(std::string& line) {
  while (true) {
    const std::string_view rest = unread();
    const std::size_t end = rest.find('\n');
    const bool whole = end != std::string_view::npos;
    if (!whole && !(input_ended_ && (!rest.empty() || too_long_))) {
      if (rest.size() > kLongestLine) {
        too_long_ = true;
        taken_ = input_.size();
        Drop(input_, taken_);
      }
      return false;
    }
    line.assign(rest.substr(0, end));
    taken_ += whole ? end + 1 : rest.size();
    Drop(input_, taken_);
    if (std::exchange(too_long_, false) || line.size() > kLongestLine) {
      ++lines_;
      Complain({.message = fmt::format("the line is longer than {} bytes", kLongestLine)});
      continue;
    }
    if (line.find_first_not_of(" \t\r") != std::string::npos) return true;
    if (!whole) return false;
  }
}

Status EvaluationPipe::ReadSome() {
  const std::size_t before = input_.size();
  input_.resize(before + kChunk);
  const ssize_t size = read(descriptors_.in, input_.data() + before, kChunk);
  input_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  if (size == 0) input_ended_ = true;
  if (size >= 0 || errno == EINTR || errno == EAGAIN) return Ok{};
  return Error{ErrorKind::kIo, fmt::format("standard input cannot be read: {}", std::strerror(errno))};
}

Status EvaluationPipe::WriteSome() {
  // A pipe that is ready takes so much without blocking.
  while (!unwritten().empty() && ReadyFor(descriptors_.out, POLLOUT)) {
    const std::string_view next = unwritten().substr(0, PIPE_BUF);
    const ssize_t size = write(descriptors_.out, next.data(), next.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) return Ok{};
    if (size < 0)
      return Error{ErrorKind::kIo,
                   fmt::format("{}standard output cannot be written: {}",
                               errno == EPIPE ? "nobody reads the answers: " : "", std::strerror(errno))};
    written_ += static_cast<std::size_t>(size);
    Drop(output_, written_);
  }
  return Ok{};
}

void EvaluationPipe::Say(const nlohmann::ordered_json& json) {
  output_ += json.dump(-1, ' ', /*ensure_ascii=*/false, nlohmann::ordered_json::error_handler_t::replace);
  output_ += '\n';
}

void EvaluationPipe::Complain(LineError wrong) {
  Say(AnswerOf(wrong, lines_));
}

Status EvaluationPipe::Take(std::string_view text) {
  ++lines_;
  LineError wrong;
  if (std::optional<EvaluationLine> line = reader_.Read(text, wrong)) return TakeLine(*std::move(line));
  Complain(std::move(wrong));
  return Ok{};
}

Status EvaluationPipe::TakeLine(EvaluationLine line) {
  if (!line.id.empty()) {
    if (const auto known = named_.find(line.id); known != named_.end())
      return AnswerAgain(open_.at(known->second).line, line);
    TRY(const std::optional<StoredLine> stored, store_->FindLine(search_, line.id));
    if (stored) return AnswerAgain(*stored, line);
  }
  Individual individual{.birth_generation = 1, .test_case = line.asked.test_case};
  StoredLine kept{.search = search_,
                  .name = line.id,
                  .content = std::move(line.content),
                  .first_run = next_run_,
                  .runs = line.asked.replicates};
  next_run_ += kept.runs;
  kept.individual = individual.id = stream_->Add(std::move(line.asked));
  store_->AddIndividuals(search_, {individual});
  store_->AddLine(kept);
  if (!kept.name.empty()) named_[kept.name] = kept.individual;
  ++waiting_;
  open_[individual.id] = {std::move(kept), {lines_}};
  return Ok{};
}

Status EvaluationPipe::AnswerAgain(const StoredLine& before, const EvaluationLine& line) {
  if (before.content != line.content) {
    Complain(
        {.id = line.id,
         .message = fmt::format("the id was given before, to individual {}, with other content: that was {}, "
                                "this is {}",
                                before.individual, before.content, line.content)});
    return Ok{};
  }
  if (const auto open = open_.find(before.individual); open != open_.end()) {
    open->second.asked_by.push_back(lines_);
    ++waiting_;
    return Ok{};
  }
  std::vector<StoredRun> runs;
  for (std::uint32_t i = 0; i < before.runs; ++i) {
    TRY(std::optional<StoredRun> run, store_->LoadRun(before.first_run + i));
    if (!run)
      return Error{ErrorKind::kCorrupt, fmt::format("a run of individual {} is missing", before.individual)};
    TRY(static_cast<RunOutcome&>(*run), OutcomeOf(*run, /*with_metrics=*/true));
    runs.push_back(*std::move(run));
  }
  std::vector<const StoredRun*> all;
  for (const StoredRun& run : runs) all.push_back(&run);
  Say(AnswerOf(experiment_, line.id, lines_, before.individual, all));
  return Ok{};
}

void EvaluationPipe::Answer(const EvaluationRequest& request, std::span<const StoredRun* const> runs) {
  const auto found = open_.find(request.individual);
  if (found == open_.end()) return;
  const Open& open = found->second;
  for (const std::uint64_t number : open.asked_by) {
    Say(AnswerOf(experiment_, open.line.name, number, request.individual, runs));
    --waiting_;
  }
  if (!open.line.name.empty()) named_.erase(open.line.name);
  open_.erase(found);
}

}  // namespace gauntlet
