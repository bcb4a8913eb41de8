/* report_stream.h: the stream for a verb's report. */
#ifndef NOH_NOH_CLI_REPORT_STREAM_H
#define NOH_NOH_CLI_REPORT_STREAM_H

#include <stdio.h>

/* stdout; or stderr if `output` is the file or pipe behind stdout (-o /dev/stdout), which must hold only the output. */
FILE *report_stream(const char *output);

#endif
