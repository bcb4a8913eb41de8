// view_panels.cpp: where the panels are. They read and change view_app, and request what needs the GPU through `wish`.
#include "view/panels/view_panels.h"
#include "view/panels/view_widgets.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace
{

bool mouse_held, popup_open, scripted;

void right_panel(view_app *a)
{
    begin_panel("figure", a->window.width - VIEW_RIGHT, 0.0f, VIEW_RIGHT, a->window.height);
    clips_section(a);
    how_section(a);
    pad_section(a);
    graph_section(a);
    lod_section(a);
    drawing_section(a);
    light_section(a);
    camera_section(a);
    compare_section(a);
    film_section(a);
    times_section(a);
    layers_section(a);
    memory_section(a);
    ImGui::End();
}

// ---- below the picture ----

void status_line(view_app *a)
{
    if (a->message[0]) {
        ImGui::PushStyleColor(ImGuiCol_Text, red);
        ImGui::TextWrapped("%s", a->message);
        ImGui::PopStyleColor();
    } else if (a->pick.is_on) {
        char text[512];
        view_pick_text(&a->pick, a->model, text, sizeof text);
        ImGui::PushStyleColor(ImGuiCol_Text, amber);
        ImGui::TextWrapped("%s", text);
        ImGui::PopStyleColor();
    } else {
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        ImGui::TextWrapped("space: %s   drag: turn   right drag: move   wheel: zoom   F: fit   F1: all keys",
                           a->playing && view_plays(a->model) ? "pause" : "play");
        ImGui::PopStyleColor();
    }
}

void key_lines(const view_app *a)
{
    const uint32_t count = a->log.total < VIEW_LINES ? a->log.total : VIEW_LINES;
    for (uint32_t i = 0; i < count; i++) {
        ImGui::TextUnformatted(a->log.lines[(a->log.next + VIEW_LINES - count + i) % VIEW_LINES]);
    }
    if (!count) {
        ImGui::TextDisabled("callback keys appear here when clips pass them");
    }
}

void events_panel(view_app *a)
{
    begin_panel("events", VIEW_LEFT, a->window.height - VIEW_BOTTOM, a->window.width - VIEW_LEFT - VIEW_RIGHT,
                VIEW_BOTTOM);
    status_line(a);
    ImGui::Separator();
    ImGui::BeginChild("lines");
    key_lines(a);
    if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) {
        ImGui::SetScrollHereY(1.0f); // follow, unless the user scrolled up
    }
    ImGui::EndChild();
    ImGui::End();
}

} // namespace

bool begin_panel(const char *name, float x, float y, float width, float height)
{
    ImGui::SetNextWindowPos(ImVec2(x, y));
    ImGui::SetNextWindowSize(ImVec2(width, height));
    return ImGui::Begin(name, nullptr,
                        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                            ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoBringToFrontOnFocus);
}

int view_panels_open(int is_scripted)
{
    scripted = is_scripted != 0;
    return imgui_open();
}

void view_panels_close(void)
{
    targets_forget();
    imgui_close();
}

void view_panels_frame(view_app *a, const view_input *input, double seconds)
{
    imgui_begin(a, input, seconds);
    ui::begin_frame(scripted, input->keys[GLFW_KEY_ESCAPE] != 0);
    if (a->window.show_panels && a->model) {
        targets_panel(a);
        right_panel(a);
        events_panel(a);
    }
    dialogs(a);
    popup_open = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup);
    a->window.hand_busy = ImGui::IsAnyItemActive() || popup_open;
    mouse_held = a->window.hand_busy ||
                 (ImGui::IsWindowHovered(ImGuiHoveredFlags_AnyWindow) &&
                  (a->window.quit_asked || a->window.show_help || a->files.load.state == VIEW_LOAD_RUNS));
    imgui_end(a);
}

int view_panels_find(const char *name, float box[4])
{
    return ui::find(name, box);
}

void view_panels_want(const char *name)
{
    ui::want(name);
}

int view_panels_hold_mouse(void)
{
    return mouse_held;
}

int view_panels_has_list(void)
{
    return popup_open;
}

int view_panels_want_keys(void)
{
    return ImGui::GetCurrentContext() && ImGui::GetIO().WantTextInput;
}
