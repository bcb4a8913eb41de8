/* session_text.h: a session as a text file (noh help FORMATS). */
#ifndef NOH_NOH_REPLAY_SESSION_TEXT_H
#define NOH_NOH_REPLAY_SESSION_TEXT_H

#include "convert/base/byte_buffer.h"
#include "convert/base/error.h"
#include "session.h"

/* Append the session to a buffer, with its hashes if it has any. *input_bytes: the bytes of the inputs. 0, or 1 and
 * *error. */
int session_write(const session *s, byte_buffer *out, size_t *input_bytes, model_error *error);

/* Read a session from a file. 0, or 1 and *error; *s is then empty. */
int session_read(session *s, const char *path, model_error *error);

#endif
