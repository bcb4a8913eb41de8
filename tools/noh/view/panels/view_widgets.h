/* view_widgets.h: Dear ImGui's controls as the panels use them. Each is known by its name, so that a script can find it
 * (view_script.h): the text in front of "##", or behind it where there is none. */
#ifndef NOH_NOH_VIEW_PANELS_VIEW_WIDGETS_H
#define NOH_NOH_VIEW_PANELS_VIEW_WIDGETS_H

#include "view/panels/view_imgui.h"

namespace ui
{

// What the controls in it belong to: "walk" makes "walk/play".
class in
{
  public:
    explicit in(const char *name);
    ~in();
    in(const in &) = delete;
    in &operator=(const in &) = delete;

  private:
    size_t length; // of the names around it
};

void begin_frame(bool noting, bool escape); // noting: controls are noted. escape: open lists are closed
void want(const char *name);
int find(const char *name, float box[4]);

// The control before it.
void note(const char *label);

bool button(const char *label, float width = 0.0f);
bool small_button(const char *label);
bool checkbox(const char *label, int *on);
bool slider(const char *label, float *value, float least, float most, const char *format, int flags = 0);
bool slider(const char *label, int *value, int least, int most, const char *format);
bool selectable(const char *label, bool chosen, int flags = 0);
bool section(const char *label, bool open_at_first);
bool text_field(const char *label, const char *hint, char *text, size_t bytes);
bool begin_combo(const char *label, const char *shown);
bool choose(const char *label, int *at, const char *const *names, int count);
void hint(const char *text); // of the control before it, under the pointer

// The width of what has its label to its right.
class labelled
{
  public:
    labelled();
    ~labelled();
    labelled(const labelled &) = delete;
    labelled &operator=(const labelled &) = delete;
};

} // namespace ui

#endif
