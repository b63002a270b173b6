// Ctrl-C as a wish to end, for verbs that have something to finish first.
#pragma once

namespace solidcast::cli {

/// While one lives, the first SIGINT or SIGTERM only asks; the second does what it did before.
class UntilInterrupt {
 public:
  UntilInterrupt();
  ~UntilInterrupt();
  UntilInterrupt(const UntilInterrupt&) = delete;

  /// The signal's number; 0: none came.
  int number() const;
  /// A file descriptor that can be read once it came.
  int readable() const;
};

}  // namespace solidcast::cli
