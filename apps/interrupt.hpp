#pragma once

/// From now on the first SIGINT or SIGTERM only makes `interrupted()` true, so that a run can end with what
/// it has; the second one kills. Says so on standard error, unless `quiet`.
void watch_for_interrupts(bool quiet);

bool interrupted();
