#include "host/cli/interrupt.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <initializer_list>

namespace solidcast::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;
volatile int event = -1;
struct sigaction before[NSIG];

void ask(int number) {
  interrupted = number;
  sigaction(number, &before[number], nullptr);
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(event, &one, sizeof one);
}

}  // namespace

UntilInterrupt::UntilInterrupt() {
  event = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  struct sigaction action {};
  action.sa_handler = ask;
  for (const int number : {SIGINT, SIGTERM}) sigaction(number, &action, &before[number]);
}

UntilInterrupt::~UntilInterrupt() {
  for (const int number : {SIGINT, SIGTERM}) sigaction(number, &before[number], nullptr);
  ::close(event);
}

int UntilInterrupt::number() const { return interrupted; }
int UntilInterrupt::readable() const { return event; }

}  // namespace solidcast::cli
