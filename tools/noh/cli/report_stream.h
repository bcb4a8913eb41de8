/* report_stream.h: where a verb reports what it did. */
#ifndef NOH_NOH_CLI_REPORT_STREAM_H
#define NOH_NOH_CLI_REPORT_STREAM_H

#include <stdio.h>

/* stdout; stderr where `output` is the pipe or file behind stdout (-o /dev/stdout | ...), which must hold nothing else.
 */
FILE *report_stream(const char *output);

#endif
