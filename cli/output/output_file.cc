#include "cli/output/output_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/system/atomic_file.h"
#include "master/directory/campaign_directory.h"
#include "search/cases/corpus_file.h"
#include "study/study_campaigns.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

Error NotOverwritten(const std::string& path, const std::string& what) {
  return InvalidInput(fmt::format("{} is {}, and not overwritten: name another file", path, what));
}

// By its place and by what it holds, through links.
Status CheckOverwritable(const std::string& path) {
  constexpr std::string_view kDatabase{"SQLite format 3\0", 16};
  constexpr std::size_t kMostOfACase = 16U << 20;
  std::error_code error;
  // "/dev/stdout", "/dev/fd/63": what this process was given
  if (fs::is_fifo(fs::status(path, error)) && !path.starts_with("/dev/") && !path.starts_with("/proc/"))
    return InvalidInput(path +
                        " is a named pipe, whose reader may never come: write to /dev/stdout and pipe that");
  const fs::path place = fs::weakly_canonical(path, error);
  if (error) return Ok{};  // said by who opens it
  if (const auto owner = CampaignDirectory::Owning(place))
    return NotOverwritten(path, "a file of the campaign " + *owner);
  if (!fs::is_regular_file(place, error)) return Ok{};
  if (place == StudyFile(place.parent_path())) return NotOverwritten(path, "the file of a study");
  std::ifstream file(place, std::ios::binary);
  std::string head(kDatabase.size(), ' ');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (head == kDatabase) return NotOverwritten(path, "a database");
  if (place.extension() != ".json") return Ok{};
  const Result<std::string> text = ReadSmallFile(place, kMostOfACase);
  return text && ParseCorpusCase(*text, path) ? Status(NotOverwritten(path, "a case of a corpus")) : Ok{};
}

}  // namespace

Result<OutputFile> OutputFile::Open(const std::string& path) {
  TRY(CheckOverwritable(path));
  return Begin(path);
}

Result<OutputFile> OutputFile::Begin(const std::string& path) {
  OutputFile output(path);
  std::error_code error;
  const auto status = std::filesystem::symlink_status(path, error);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) {
    const mode_t mask = umask(0);
    umask(mask);
    Result<FileReplacement> file = FileReplacement::Begin(path, 0666 & ~mask);
    if (!file) return output.Named(file.error()).error();
    output.file_.emplace(*std::move(file));
    return output;
  }
  errno = 0;
  output.stream_.open(path, std::ios::binary | std::ios::trunc);
  TRY(output.OfStream());
  return output;
}

Status OutputFile::Write(std::string_view bytes) {
  if (file_) return Named(file_->Write(bytes));
  errno = 0;
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return OfStream();
}

Status OutputFile::Close() {
  if (file_) return Named(file_->Finish());
  errno = 0;
  stream_.close();
  return OfStream();
}

Status OutputFile::Named(const Status& written) const {
  if (written) return written;
  return Error{written.error().kind,
               fmt::format("{}: cannot be written: {}", path_, written.error().message)};
}

Status OutputFile::OfStream() const {
  if (stream_) return Ok{};
  return Error{ErrorKind::kIo, fmt::format("{}: cannot be written: {}", path_, std::strerror(errno))};
}

Status WriteOwnFile(const std::string& path, std::string_view content) {
  TRY(OutputFile output, OutputFile::Begin(path));
  TRY(output.Write(content));
  return output.Close();
}

Status WriteOutputFile(const std::string& path, std::string_view content) {
  TRY(OutputFile output, OutputFile::Open(path));
  TRY(output.Write(content));
  return output.Close();
}

Result<std::uint64_t> WriteOutputDirectory(
    const std::string& option, const std::string& path,
    const std::function<Result<std::uint64_t>(const std::string& draft)>& write) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::exists(path, error) && !(fs::is_directory(path, error) && fs::is_empty(path, error)))
    return InvalidInput(fmt::format(
        "{} {}: there is something already; give a directory that is new or empty", option, path));
  const std::string place = fs::path(path).has_filename() ? path : fs::path(path).parent_path().string();
  std::string draft = place + ".XXXXXX";
  if (mkdtemp(draft.data()) == nullptr)
    return SystemError(fmt::format("{} {}: no directory can be made there", option, path), errno);
  Result<std::uint64_t> files = write(draft);
  if (files) {
    const mode_t mask = umask(0);
    umask(mask);
    if (chmod(draft.c_str(), 0777 & ~mask) != 0 || rename(draft.c_str(), place.c_str()) != 0)
      files = SystemError(fmt::format("{} {}: cannot be put there", option, path), errno);
  }
  if (!files) fs::remove_all(draft, error);
  return files;
}

}  // namespace gauntlet
