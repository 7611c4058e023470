/* Lines of a Wavefront OBJ file that Assimp takes for something else without a word. Its reader
 * (5.2) passes over a vertex that has not three, four or six numbers, takes .5 for none, and knows
 * no line that begins with a blank; faces behind a vertex that is lost would be made of wrong
 * corners. Faces before the first usemtl get its material. */
#ifndef VISUAL_OBJ_CHECK_H
#define VISUAL_OBJ_CHECK_H

/* Look at each line of the file at `path`; `name` is for messages. Returns 0, or -1 with the error
 * reported: unreadable, or a line of that kind. Cost: reads the file once. */
int obj_check(const char *path, const char *name);

#endif
