#pragma once

/// Exit codes of scree. kWatchFailed: a run broke the physics watch (sim/scene/watch.h) or blew up.
enum ExitCode { kOk = 0, kFailed = 1, kBadInput = 2, kWatchFailed = 3, kInterrupted = 130 };
