// Parses a command's options, with --help and errors that name the nearest option; words for a command that a message
// suggests.
#pragma once

#include <boost/program_options.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace rouleau::command {

/// Stores the options' values. Returns false after printing `help` and the options when --help or -h is among the
/// arguments.
/// Throws Error(bad_input) for an unknown option (nearest name), a missing or malformed value, a missing argument.
bool parse_command_line(const std::string& command, const std::string& help, const std::vector<std::string>& arguments,
                        boost::program_options::options_description& description,
                        const boost::program_options::positional_options_description& positional);

/// Notifier of an option that names a file or a directory: throws Error(bad_input) where it is empty, as a variable of
/// a shell may be that nobody has set.
std::function<void(const std::string&)> not_empty(const std::string& option);

/// The value of an option that is a time above zero: "5min", "1.5 h", or a plain number of seconds. Throws
/// Error(bad_input).
double seconds_in(const std::string& option, const std::string& text);

/// Where a command writes that was given this file and no --out: runs/NAME. Throws Error for a file without a name.
std::filesystem::path directory_for(const std::string& file);

/// A word as a shell reads it: in quotes where it needs them.
std::string in_shell(const std::string& word);

}  // namespace rouleau::command
