// The programs of a release: starts libexec/NAME of the folder above this file's with the loader, the C
// library and the C++ library of the release, or with those of this machine where they are newer, for what is
// compiled here may need them. Linked statically, so that it runs on any x86-64 Linux: it needs no shell, no
// /proc and no library.
#include <fcntl.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

constexpr char kLoader[] = "/lib64/ld-linux-x86-64.so.2";  // of every x86-64 Linux with glibc
// What files say of themselves: the loader its release, the C++ library each version that it offers.
constexpr std::string_view kLoaderRelease = "release version 2.";
constexpr std::string_view kLibraryVersion = "GLIBCXX_3.4.";

// The highest number that stands behind `mark` in the file; -1: there is none, or no file.
int NewestIn(const std::string& file, std::string_view mark) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status = {};
  if (descriptor < 0 || fstat(descriptor, &status) != 0 || status.st_size <= 0) return -1;
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const bytes = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  close(descriptor);
  if (bytes == MAP_FAILED) return -1;
  const std::string_view text(static_cast<const char*>(bytes), size);
  int newest = -1;
  if (text.starts_with("\177ELF\1")) return newest;  // of 32-bit programs
  for (std::size_t at = text.find(mark); at != text.npos; at = text.find(mark, at)) {
    at += mark.size();
    int number = -1;
    for (; at < size && text[at] >= '0' && text[at] <= '9' && number < 10000; ++at)
      number = std::max(number, 0) * 10 + (text[at] - '0');
    newest = std::max(newest, number);
  }
  munmap(bytes, size);
  return newest;
}

std::vector<std::string> Split(std::string_view paths) {
  std::vector<std::string> folders;
  while (!paths.empty()) {
    const std::size_t end = std::min(paths.find(':'), paths.size());
    if (end > 0) folders.emplace_back(paths.substr(0, end));
    paths.remove_prefix(std::min(end + 1, paths.size()));
  }
  return folders;
}

// This machine's C++ library, if one is newer than `ours`; else "".
std::string NewerLibrary(const std::vector<std::string>& folders, int ours) {
  std::string newest;
  for (const std::string& folder : folders) {
    const std::string file = folder + "/libstdc++.so.6";
    const int version = NewestIn(file, kLibraryVersion);
    if (version <= ours) continue;
    newest = file;
    ours = version;
  }
  return newest;
}

int Failed(const std::string& what) {
  std::fprintf(stderr, "gauntlet: cannot start: %s: %s\n", what.c_str(), std::strerror(errno));
  return 126;
}

}  // namespace

int main(int argc, char** argv) {
  const auto* const executed = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  char* const resolved = realpath(executed == nullptr ? argv[0] : executed, nullptr);
  if (resolved == nullptr) return Failed(executed == nullptr ? argv[0] : executed);
  const std::string self = resolved;  // ROOT/bin/NAME
  const std::size_t name_at = self.rfind('/') + 1;
  const std::string name = self.substr(name_at);
  const std::string root = self.substr(0, self.rfind('/', name_at < 2 ? 0 : name_at - 2));
  if (root.find_first_of(":;") != root.npos) {
    std::fprintf(stderr,
                 "gauntlet: cannot start: %s: a path with ':' or ';' separates libraries; move the folder\n",
                 root.c_str());
    return 126;
  }
  const std::string lib = root + "/lib";
  const std::string program = root + "/libexec/" + name;
  if (access(program.c_str(), X_OK) != 0) return Failed(program);

  const char* const given = std::getenv("LD_LIBRARY_PATH");
  const std::string paths = given == nullptr ? "" : given;
  std::vector<std::string> folders = Split(paths);
  for (const char* folder :
       {"/lib/x86_64-linux-gnu", "/usr/lib/x86_64-linux-gnu", "/lib64", "/usr/lib64", "/usr/lib"})
    folders.emplace_back(folder);
  const std::string own_loader = lib + "/libc/ld-linux-x86-64.so.2";
  const bool own_libc = NewestIn(kLoader, kLoaderRelease) <= NewestIn(own_loader, kLoaderRelease);
  const std::string newer =
      NewerLibrary(folders, NewestIn(lib + "/libstdc++/libstdc++.so.6", kLibraryVersion));

  const std::string loader = own_libc ? own_loader : kLoader;
  const std::string library_path = lib + (own_libc ? ":" + lib + "/libc" : "") +
                                   (newer.empty() ? ":" + lib + "/libstdc++" : "") +
                                   (paths.empty() ? "" : ":" + paths);
  std::vector<std::string> words = {loader, "--library-path", library_path};
  if (!newer.empty()) words.insert(words.end(), {"--preload", newer});
  words.push_back(program);
  words.insert(words.end(), argv + std::min(argc, 1), argv + argc);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  setenv("GAUNTLET_PROGRAM", (root + "/bin/gauntlet").c_str(), 1);
  execv(loader.c_str(), arguments.data());
  return Failed(loader);
}
