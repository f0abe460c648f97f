// Runs gnuplot on a script.
#include "analysis/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

extern char** environ;

namespace parafovea {

std::string gnuplot_quoted(const std::string& text) {
    std::string quoted = "\"";
    for (char c : text) {
        if (c == '\n') {
            quoted += "\\n";
            continue;
        }
        if (c == '"' || c == '\\') quoted += '\\';
        if (c == '_' || c == '^' || c == '{' || c == '}' || c == '@' || c == '&' || c == '~')
            quoted += "\\\\";
        quoted += c;
    }
    return quoted + "\"";
}

void run_gnuplot(const std::string& script) {
    // Both ends are files without a name: gnuplot can neither block on a full pipe nor leave anything behind.
    const int input = static_cast<int>(memfd_create("gnuplot-script", MFD_CLOEXEC));
    const int errors = static_cast<int>(memfd_create("gnuplot-errors", MFD_CLOEXEC));
    if (input < 0 || errors < 0)
        throw std::runtime_error(std::string("gnuplot: no memory file: ") + std::strerror(errno));
    std::size_t written = 0;
    while (written < script.size()) {
        const ssize_t count = write(input, script.data() + written, script.size() - written);
        if (count < 0)
            throw std::runtime_error(std::string("gnuplot: cannot pass the script: ") + std::strerror(errno));
        written += static_cast<std::size_t>(count);
    }
    lseek(input, 0, SEEK_SET);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, errors, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
    // By its name, not as "-": gnuplot reads "-" one byte at a time.
    std::string program = "gnuplot", defaults = "--default-settings", script_file = "/dev/stdin";
    char* arguments[] = {program.data(), defaults.data(), script_file.data(), nullptr};
    pid_t child = 0;
    const int failure = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(input);
    if (failure != 0) {
        close(errors);
        throw std::runtime_error(std::string("figures need gnuplot, which cannot be started (") +
                                 std::strerror(failure) + "); install the package gnuplot-nox");
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    std::string messages(4096, '\0');
    const ssize_t length = pread(errors, messages.data(), messages.size(), 0);
    messages.resize(length > 0 ? static_cast<std::size_t>(length) : 0);
    close(errors);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        for (char& c : messages)
            if (c == '\n') c = ' ';
        throw std::runtime_error("gnuplot failed: " + (messages.empty() ? "no message" : messages));
    }
}

}  // namespace parafovea
