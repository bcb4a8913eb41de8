/* Memory, or the end of the program. */
#ifndef MASK_GRAB_H
#define MASK_GRAB_H

/* realloc of count * size bytes; old may be NULL. Ends the program with a message when there is no memory. */
void *grab(void *old, int count, int size);

#endif
