// Runs gnuplot on a script.
#pragma once

#include <string>

namespace parafovea {

// The script sets its own terminals and outputs. Throws std::runtime_error with gnuplot's own first message
// when it fails, and with the package to install when there is no gnuplot.
void run_gnuplot(const std::string& script);

// Text as a double-quoted gnuplot string with enhanced-text marks and quotes made harmless.
std::string gnuplot_quoted(const std::string& text);

}  // namespace parafovea
