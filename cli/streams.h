#pragma once
// Standard streams that may be closed, full or cut off at any time.

/// Opens those that were closed (>&-), which would else be files that a run opens, and keeps errors of what
/// is said from ending anything: of stderr's nobody hears, stdout's are told by with_all_said().
void make_streams_safe();

/// The code, unless something that was said on stdout was lost, and not because its reader had enough: then a
/// message, and kFailed in place of kOk.
int with_all_said(int code);
