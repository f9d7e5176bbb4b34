#include "tests/support/process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/check.h"

namespace gauntlet::testing_support {
namespace {

int OpenScratchFile() {
  char path[] = "/tmp/gauntlet-test-XXXXXX";
  const int fd = mkostemp(path, O_CLOEXEC);
  GAUNTLET_CHECK(fd >= 0, "no scratch file");
  unlink(path);
  return fd;
}

std::string ReadAll(int fd) {
  std::string text;
  char buffer[4096];
  off_t offset = 0;
  for (;;) {
    const ssize_t size = pread(fd, buffer, sizeof buffer, offset);
    if (size <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(size));
    offset += size;
  }
}

void Pause(std::chrono::milliseconds time) {
  poll(nullptr, 0, static_cast<int>(time.count()));
}

}  // namespace

Process::Process(const std::vector<std::string>& argv, const std::vector<std::string>& environment)
    : out_fd_(OpenScratchFile()), err_fd_(OpenScratchFile()) {
  std::vector<std::string> arguments = argv;
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);

  std::vector<std::string> variables = environment;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view name(*variable, static_cast<std::size_t>(std::strcspn(*variable, "=")) + 1);
    bool overridden = false;
    for (const std::string& given : environment) overridden |= given.substr(0, name.size()) == name;
    if (!overridden) variables.emplace_back(*variable);
  }
  std::vector<char*> variable_pointers;
  for (std::string& variable : variables) variable_pointers.push_back(variable.data());
  variable_pointers.push_back(nullptr);

  pid_ = fork();
  GAUNTLET_CHECK(pid_ >= 0, "fork failed");
  if (pid_ == 0) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves nothing behind
    const int null_fd = open("/dev/null", O_RDONLY);
    dup2(null_fd, STDIN_FILENO);
    dup2(out_fd_, STDOUT_FILENO);
    dup2(err_fd_, STDERR_FILENO);
    execve(pointers[0], pointers.data(), variable_pointers.data());
    _exit(127);
  }
}

Process::~Process() {
  if (!Reap(false)) {
    Signal(SIGKILL);
    Reap(true);
  }
  close(out_fd_);
  close(err_fd_);
}

bool Process::Reap(bool block) {
  if (reaped_) return true;
  const pid_t ended = waitpid(pid_, &status_, block ? 0 : WNOHANG);
  reaped_ = ended == pid_;
  return reaped_;
}

bool Process::Running() {
  return !Reap(false);
}

void Process::Signal(int signal) const {
  if (!reaped_) kill(pid_, signal);
}

ProcessResult Process::Wait(std::chrono::seconds deadline) {
  if (!Eventually([this] { return Reap(false); }, deadline)) {
    Signal(SIGKILL);
    Reap(true);
  }
  ProcessResult result;
  if (WIFEXITED(status_)) result.exit_code = WEXITSTATUS(status_);
  if (WIFSIGNALED(status_)) result.signal = WTERMSIG(status_);
  result.out = Out();
  result.err = Err();
  return result;
}

std::string Process::Out() const {
  return ReadAll(out_fd_);
}
std::string Process::Err() const {
  return ReadAll(err_fd_);
}

ProcessResult RunProcess(const std::vector<std::string>& argv, const std::vector<std::string>& environment,
                         std::chrono::seconds deadline) {
  Process process(argv, environment);
  return process.Wait(deadline);
}

bool Eventually(const std::function<bool()>& condition, std::chrono::milliseconds deadline) {
  const auto end = std::chrono::steady_clock::now() + deadline;
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= end) return false;
    Pause(std::chrono::milliseconds(5));
  }
  return true;
}

bool Alive(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  if (!std::getline(stat, line)) return false;
  const std::size_t name_end = line.rfind(')');
  return name_end != std::string::npos && name_end + 2 < line.size() && line[name_end + 2] != 'Z';
}

std::vector<pid_t> ChildrenOf(pid_t pid) {
  std::vector<pid_t> children;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream stat(entry.path() / "stat");
    std::string line;
    if (!std::getline(stat, line)) continue;
    const std::size_t name_end = line.rfind(')');
    if (name_end == std::string::npos || line[name_end + 2] == 'Z') continue;
    if (std::atoi(line.c_str() + name_end + 4) == pid) children.push_back(std::atoi(name.c_str()));
  }
  return children;
}

std::vector<pid_t> DescendantsOf(pid_t pid) {
  std::vector<pid_t> all = ChildrenOf(pid);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::vector<pid_t> children = ChildrenOf(all[i]);
    all.insert(all.end(), children.begin(), children.end());
  }
  return all;
}

TemporaryDirectory::TemporaryDirectory() {
  char path[] = "/tmp/gauntlet-test-XXXXXX";
  GAUNTLET_CHECK(mkdtemp(path) != nullptr, "no temporary directory");
  path_ = path;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace gauntlet::testing_support
