/* view_imgui.h: feeds Dear ImGui with the window's input and draws it with view_screen. Differences between its
 * versions are handled here alone. */
#ifndef NOH_NOH_VIEW_PANELS_VIEW_IMGUI_H
#define NOH_NOH_VIEW_PANELS_VIEW_IMGUI_H

#include "view/panels/view_panels.h"

#include <imgui.h>

// GL's name of a texture as ImGui keeps it.
ImTextureID imgui_texture(GLuint name);

const ImVec4 amber(0.93f, 0.70f, 0.36f, 1.0f), red(0.95f, 0.45f, 0.38f, 1.0f);

// Prints an error and returns an exit code; 0 on success.
int imgui_open();
void imgui_close();

// Between the two: the panels.
void imgui_begin(view_app *a, const view_input *input, double seconds);
void imgui_end(view_app *a);

// Linear light to a colour of the panels.
ImU32 imgui_color(const float rgb[3]);

bool begin_panel(const char *name, float x, float y, float width, float height);

// The left panel; what lies over the picture.
void targets_panel(view_app *a);
void targets_forget();
void dialogs(view_app *a);

// Sections of the right panel, from its top: the clips; what plays of them; how the next one plays; a blend space; a
// graph; LOD levels; what is drawn; its light; camera and floor; a second figure; films; what it costs.
void clips_section(view_app *a);
void tracks_list(view_app *a);
void how_section(view_app *a);
void pad_section(view_app *a);
void graph_section(view_app *a);
void lod_section(view_app *a);
void drawing_section(view_app *a);
void light_section(view_app *a);
void camera_section(view_app *a);
void compare_section(view_app *a);
void film_section(view_app *a);
void times_section(view_app *a);
void layers_section(view_app *a);
void memory_section(view_app *a);

#endif
