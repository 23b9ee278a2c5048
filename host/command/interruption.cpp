#include "interruption.hpp"

#include <csignal>

namespace rouleau::command {

namespace {

std::atomic<bool> interruption_asked = false;
void ask_for_interruption(int) { interruption_asked = true; }

}  // namespace

const std::atomic<bool>& listen_for_interruption() {
  struct sigaction action {};
  action.sa_handler = ask_for_interruption;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction present {};
    sigaction(signal, nullptr, &present);
    if (present.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);  // nohup wants no end with the terminal
  }
  return interruption_asked;
}

}  // namespace rouleau::command
