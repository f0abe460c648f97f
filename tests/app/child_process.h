// The program, run by a test.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace parafovea {

// What a run of the program said, and how it ended.
struct ProgramOutput {
    int exit_code = -1;
    std::string out, errors;  // standard output and error
};

// Runs the program in a folder to its end. The environment is in the shell's words: "NAME=value".
inline ProgramOutput run_program(const TemporaryFolder& folder, const std::string& arguments,
                                 const std::string& environment = "") {
    const std::string command = "cd '" + folder.path().string() + "' && " + environment + " " +
                                PARAFOVEA_PROGRAM + " " + arguments + " >out.txt 2>errors.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder / "out.txt"),
            text_of(folder / "errors.txt")};
}

// A child process with its output thrown away; killed at the end of its life if it still runs.
class Child {
  public:
    explicit Child(std::vector<std::string> arguments,
                   const std::map<std::string, std::string>& environment = {})
        : pid_(fork()) {
        if (pid_ != 0) return;
        for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
        std::vector<char*> raw;
        for (std::string& argument : arguments) raw.push_back(argument.data());
        raw.push_back(nullptr);
        if (freopen("/dev/null", "w", stdout) && freopen("/dev/null", "w", stderr)) execv(raw[0], raw.data());
        _exit(127);
    }
    Child(const Child&) = delete;
    ~Child() {
        if (pid_ > 0) kill_and_wait();
    }

    int wait() {
        int status = 0;
        waitpid(pid_, &status, 0);
        pid_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    int kill_and_wait() {
        kill(pid_, SIGKILL);
        return wait();
    }
    void interrupt() const { kill(pid_, SIGINT); }
    bool runs() const {
        siginfo_t info{};
        return waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
               info.si_pid == 0;
    }

  private:
    pid_t pid_;
};

}  // namespace parafovea
