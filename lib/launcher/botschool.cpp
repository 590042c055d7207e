// The command `botschool`: starts the Python that it was installed with, and holds Ctrl-C back until
// botschool.cli.main can answer it. Python's own start would answer with a traceback.
#include <string>
#include <vector>

// In this mode Python looks for modules in the working directory first, which need not be trusted.
#define PROGRAM                                                                       \
  "import sys; sys.path[:1] == [''] and sys.path.pop(0); sys.argv[0] = 'botschool'; " \
  "from botschool.cli import main; main()"

#ifdef _WIN32

#include <windows.h>

/// The words after the first one, as they were typed.
static const wchar_t* words_after_first(const wchar_t* line) {
  const wchar_t end = *line == L'"' ? L'"' : L' ';
  if (end == L'"') ++line;
  while (*line && *line != end) ++line;
  return end == L'"' && *line ? line + 1 : line;
}

int main() {
  wchar_t self[32768];
  GetModuleFileNameW(nullptr, self, 32768);
  const std::wstring path = self, folder = path.substr(0, path.rfind(L'\\') + 1);
  SetConsoleCtrlHandler(nullptr, FALSE);
  for (const wchar_t* python : {L"python.exe", L"..\\python.exe"}) {
    std::wstring line = L"\"" + folder + python +
                        L"\" -c \""
                        L"" PROGRAM L"\" " +
                        words_after_first(GetCommandLineW());
    STARTUPINFOW start{};
    start.cb = sizeof start;
    PROCESS_INFORMATION process{};
    if (!CreateProcessW((folder + python).c_str(), line.data(), nullptr, nullptr, TRUE, 0, nullptr,
                        nullptr, &start, &process))
      continue;
    SetConsoleCtrlHandler(nullptr, TRUE);  // Ctrl-C is for Python alone
    WaitForSingleObject(process.hProcess, INFINITE);
    DWORD code = 2;
    GetExitCodeProcess(process.hProcess, &code);
    return static_cast<int>(code);
  }
  return 2;
}

#else

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif

/// The folder that holds this program, links followed, with a slash at the end.
static std::string own_folder() {
#ifdef __APPLE__
  char path[4096];
  std::uint32_t size = sizeof path;
  if (_NSGetExecutablePath(path, &size) != 0) return "";
  char* found = realpath(path, nullptr);
#else
  char* found = realpath("/proc/self/exe", nullptr);
#endif
  const std::string self = found ? found : "";
  std::free(found);
  return self.substr(0, self.rfind('/') + 1);
}

int main(int argc, char** argv) {
  sigset_t ctrl_c;
  sigemptyset(&ctrl_c);
  sigaddset(&ctrl_c, SIGINT);
  sigprocmask(SIG_BLOCK, &ctrl_c, nullptr);

  // `pip install --user` has no Python beside its commands.
  std::string name = BOTSCHOOL_PYTHON, option = "-c", program = PROGRAM;
  std::vector<std::string> pythons;
  for (const std::string& folder :
       {own_folder(), std::string("/usr/bin/"), std::string("/usr/local/bin/")})
    pythons.push_back(folder + name);
  std::vector<char*> words{nullptr, option.data(), program.data()};
  words.insert(words.end(), argv + (argc > 0), argv + argc + 1);
  for (std::string& python : pythons) {
    words[0] = python.data();
    execv(words[0], words.data());
  }
  words[0] = name.data();  // without a folder, by which Python would look for its library
  execvp(words[0], words.data());
  std::fprintf(stderr, "error: botschool was installed for %s, and there is none.\n",
               BOTSCHOOL_PYTHON);
  return 2;
}

#endif
