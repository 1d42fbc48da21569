#include "spawned.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace ductile::cli {
namespace {

namespace fs = std::filesystem;

fs::path beside(const Folder& folder, const char* what) {
  return folder.path().string() + "." + what;
}

void redirect(int descriptor, const fs::path& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file < 0 || ::dup2(file, descriptor) < 0) ::_exit(127);
}

}  // namespace

pid_t spawn(const Folder& folder, const std::string& words, const Environment& more) {
  std::vector<std::string> list{DUCTILE_PROGRAM}, settings;
  std::istringstream stream(words);
  for (std::string word; stream >> word;) list.push_back(word);
  std::vector<char*> arguments, environment;
  for (std::string& word : list) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  for (const auto& [name, value] : more) settings.push_back(name + "=" + value);
  for (char** setting = environ; *setting != nullptr; ++setting) environment.push_back(*setting);
  for (std::string& setting : settings) environment.push_back(setting.data());
  environment.push_back(nullptr);
  const fs::path out = beside(folder, "out"), err = beside(folder, "err");
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child > 0) return child;
  if (::chdir(folder.path().c_str()) != 0) ::_exit(127);
  redirect(STDOUT_FILENO, out);
  redirect(STDERR_FILENO, err);
  ::execve(DUCTILE_PROGRAM, arguments.data(), environment.data());
  ::_exit(127);
}

std::optional<int> wait_for(pid_t child, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (Clock::now() > end) {
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      return std::nullopt;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::string errors_of(const Folder& folder) { return folder.read(beside(folder, "err").string()); }

void add_small_meshes(const Folder& folder) {
  folder.write("s.mesh",
               "MeshVersionFormatted 2\nDimension 2\nVertices 9\n0 0 0\n.5 0 0\n1 0 0\n0 .5 0\n"
               ".5 .5 0\n1 .5 0\n0 1 0\n.5 1 0\n1 1 0\nEdges 8\n1 2 1\n2 3 1\n3 6 1\n6 9 1\n9 8 1\n"
               "8 7 1\n7 4 1\n4 1 1\nTriangles 8\n1 2 5 1\n1 5 4 1\n2 3 6 1\n2 6 5 1\n4 5 8 1\n"
               "4 8 7 1\n5 6 9 1\n5 9 8 1\nEnd\n");
  folder.write("s.sol",
               "MeshVersionFormatted 2\nDimension 2\nSolAtVertices 9\n1 1\n.3 .35 .5 .35 .4 .5 .4 "
               ".45 .6\nEnd\n");
  folder.write(
      "t.mesh",
      "MeshVersionFormatted 2\nDimension 3\nVertices 5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
      "1 1 1 0\nTriangles 6\n1 2 3 1\n1 2 4 1\n1 3 4 1\n2 3 5 1\n2 4 5 1\n3 4 5 1\n"
      "Tetrahedra 2\n1 2 3 4 1\n2 3 4 5 1\nEnd\n");
}

std::map<std::string, std::string> contents_of(const Folder& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename().string();
    contents[name] = folder.read(name);
  }
  return contents;
}

}  // namespace ductile::cli
