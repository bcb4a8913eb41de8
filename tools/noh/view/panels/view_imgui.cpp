// view_imgui.cpp: Dear ImGui's input, letters, style and triangles.
#include "view/panels/view_imgui.h"

#include <cmath>
#include <cstddef>

#include "cli/message.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

static_assert(sizeof(ImDrawVert) == sizeof(view_vertex) && offsetof(ImDrawVert, uv) == offsetof(view_vertex, uv) &&
                  offsetof(ImDrawVert, col) == offsetof(view_vertex, color) && sizeof(ImDrawIdx) == sizeof(uint16_t),
              "view_screen draws ImGui's vertices as they are");

namespace
{

float font_scale; // that the letters were drawn at

// ---- input ----

struct key_pair {
    ImGuiKey panels;
    int window; // GLFW's
};

const key_pair keys[] = {
    { ImGuiKey_Tab, GLFW_KEY_TAB },
    { ImGuiKey_LeftArrow, GLFW_KEY_LEFT },
    { ImGuiKey_RightArrow, GLFW_KEY_RIGHT },
    { ImGuiKey_UpArrow, GLFW_KEY_UP },
    { ImGuiKey_DownArrow, GLFW_KEY_DOWN },
    { ImGuiKey_Home, GLFW_KEY_HOME },
    { ImGuiKey_End, GLFW_KEY_END },
    { ImGuiKey_Delete, GLFW_KEY_DELETE },
    { ImGuiKey_Backspace, GLFW_KEY_BACKSPACE },
    { ImGuiKey_Space, GLFW_KEY_SPACE },
    { ImGuiKey_Enter, GLFW_KEY_ENTER },
    { ImGuiKey_Escape, GLFW_KEY_ESCAPE },
    { ImGuiKey_A, GLFW_KEY_A },
    { ImGuiKey_C, GLFW_KEY_C },
    { ImGuiKey_V, GLFW_KEY_V },
    { ImGuiKey_X, GLFW_KEY_X },
    { ImGuiKey_Z, GLFW_KEY_Z },
};

#if IMGUI_VERSION_NUM >= 18900 // input as events

void set_up_input(ImGuiIO &io)
{
    io.ConfigInputTrickleEventQueue = false; // a frame's input in that frame
}

void take_buttons_and_keys(ImGuiIO &io, const view_input *input, bool control, bool shift)
{
    io.AddMousePosEvent(input->mouse[0], input->mouse[1]);
    for (int i = 0; i < 3; i++) {
        io.AddMouseButtonEvent(i, input->buttons[i] != 0);
    }
    io.AddMouseWheelEvent(0.0f, input->wheel);
    for (const key_pair &key : keys) {
        io.AddKeyEvent(key.panels, input->keys[key.window] != 0);
    }
    io.AddKeyEvent(ImGuiMod_Ctrl, control);
    io.AddKeyEvent(ImGuiMod_Shift, shift);
}

#else

void set_up_input(ImGuiIO &io)
{
    for (const key_pair &key : keys) {
        io.KeyMap[key.panels] = key.window;
    }
}

void take_buttons_and_keys(ImGuiIO &io, const view_input *input, bool control, bool shift)
{
    io.MousePos = ImVec2(input->mouse[0], input->mouse[1]);
    for (int i = 0; i < 3; i++) {
        io.MouseDown[i] = input->buttons[i] != 0;
    }
    io.MouseWheel = input->wheel;
    for (size_t k = 0; k < sizeof input->keys; k++) {
        io.KeysDown[k] = input->keys[k] != 0;
    }
    io.KeyCtrl = control;
    io.KeyShift = shift;
}

#endif

void take_input(const view_app *a, const view_input *input, double seconds)
{
    ImGuiIO &io = ImGui::GetIO();
    io.DisplaySize = ImVec2(a->window.width, a->window.height);
    io.DeltaTime = seconds > 0.0 ? static_cast<float>(seconds) : 1.0f / 60.0f;
    take_buttons_and_keys(io, input, input->keys[GLFW_KEY_LEFT_CONTROL] || input->keys[GLFW_KEY_RIGHT_CONTROL],
                          input->keys[GLFW_KEY_LEFT_SHIFT] || input->keys[GLFW_KEY_RIGHT_SHIFT]);
    for (int i = 0; i < input->letter_count; i++) {
        io.AddInputCharacter(input->letters[i]);
    }
}

// ---- letters, style, triangles ----

// The letters are drawn at the screen's density and laid out in points.
void load_font(view_app *a)
{
    const float points = 13.0f; // ImGui's own font is made for this size
    ImGuiIO &io = ImGui::GetIO();
    ImFontConfig config;
    unsigned char *rgba = nullptr;
    int width = 0, height = 0;
    config.OversampleH = config.OversampleV = 1;
    config.PixelSnapH = true;
    config.SizePixels = std::round(points * a->window.scale);
    io.Fonts->Clear();
    io.Fonts->AddFontDefault(&config);
    io.FontGlobalScale = points / config.SizePixels;
    io.Fonts->GetTexDataAsRGBA32(&rgba, &width, &height);
    view_screen_font(&a->screen, static_cast<uint32_t>(width), static_cast<uint32_t>(height), rgba);
    io.Fonts->SetTexID(imgui_texture(a->screen.font));
    font_scale = a->window.scale;
}

void draw(view_app *a)
{
    const ImDrawData *data = ImGui::GetDrawData();
    view_triangles_begin(&a->screen, a->window.width, a->window.height);
    for (int i = 0; i < data->CmdListsCount; i++) {
        const ImDrawList *list = data->CmdLists[i];
        view_triangles_list(&a->screen, reinterpret_cast<const view_vertex *>(list->VtxBuffer.Data),
                            static_cast<size_t>(list->VtxBuffer.Size), list->IdxBuffer.Data,
                            static_cast<size_t>(list->IdxBuffer.Size));
        for (const ImDrawCmd &command : list->CmdBuffer) {
            const float clip[4] = { command.ClipRect.x, command.ClipRect.y, command.ClipRect.z, command.ClipRect.w };
            view_triangles_draw(&a->screen, clip, (GLuint)(intptr_t)command.GetTexID(), command.IdxOffset,
                                command.ElemCount);
        }
    }
    view_triangles_end(&a->screen);
}

void set_style()
{
    ImGuiStyle &style = ImGui::GetStyle();
    ImGui::StyleColorsDark();
    style.WindowRounding = 0.0f;
    style.WindowBorderSize = 0.0f;
    style.FrameRounding = 2.0f;
    style.ItemSpacing = ImVec2(6.0f, 4.0f);
    style.Colors[ImGuiCol_WindowBg] = ImVec4(0.13f, 0.13f, 0.14f, 1.0f);
    style.Colors[ImGuiCol_PopupBg] = ImVec4(0.16f, 0.16f, 0.17f, 1.0f);
    style.Colors[ImGuiCol_TextDisabled] = ImVec4(0.64f, 0.64f, 0.66f, 1.0f);
    style.Colors[ImGuiCol_FrameBg] = ImVec4(0.22f, 0.22f, 0.24f, 1.0f);
    style.Colors[ImGuiCol_FrameBgHovered] = ImVec4(0.30f, 0.30f, 0.32f, 1.0f);
    style.Colors[ImGuiCol_FrameBgActive] = ImVec4(0.34f, 0.34f, 0.36f, 1.0f);
    style.Colors[ImGuiCol_Header] = ImVec4(0.26f, 0.24f, 0.21f, 1.0f);
    style.Colors[ImGuiCol_HeaderHovered] = ImVec4(0.36f, 0.32f, 0.26f, 1.0f);
    style.Colors[ImGuiCol_HeaderActive] = ImVec4(0.42f, 0.36f, 0.28f, 1.0f);
    style.Colors[ImGuiCol_Button] = ImVec4(0.30f, 0.28f, 0.25f, 1.0f);
    style.Colors[ImGuiCol_ButtonHovered] = ImVec4(0.46f, 0.38f, 0.27f, 1.0f);
    style.Colors[ImGuiCol_ButtonActive] = ImVec4(0.58f, 0.46f, 0.30f, 1.0f);
    style.Colors[ImGuiCol_SliderGrab] = ImVec4(0.47f, 0.41f, 0.33f, 1.0f);
    style.Colors[ImGuiCol_SliderGrabActive] = ImVec4(0.70f, 0.50f, 0.22f, 1.0f);
    style.Colors[ImGuiCol_CheckMark] = style.Colors[ImGuiCol_PlotLines] = ImVec4(0.93f, 0.70f, 0.36f, 1.0f);
}

} // namespace

ImTextureID imgui_texture(GLuint name)
{
    return (ImTextureID)(intptr_t)name; // a pointer or an integer, by version
}

ImU32 imgui_color(const float rgb[3])
{
    float bytes[3];
    for (int i = 0; i < 3; i++) {
        bytes[i] = rgb[i] > 0.0031308f ? 1.055f * std::pow(rgb[i], 1.0f / 2.4f) - 0.055f : 12.92f * rgb[i];
    }
    return ImGui::ColorConvertFloat4ToU32(ImVec4(bytes[0], bytes[1], bytes[2], 1.0f));
}

int imgui_open()
{
    if (!IMGUI_CHECKVERSION() || !ImGui::CreateContext()) {
        return tool_fail("view", "Dear ImGui's library and headers differ");
    }
    ImGui::GetIO().IniFilename = nullptr; // nothing is written
    set_up_input(ImGui::GetIO());
    set_style();
    return 0;
}

void imgui_close()
{
    if (ImGui::GetCurrentContext()) {
        ImGui::DestroyContext();
    }
}

void imgui_begin(view_app *a, const view_input *input, double seconds)
{
    if (!a->screen.font || a->window.scale != font_scale) { // the first frame, a new context, another screen
        load_font(a);
    }
    take_input(a, input, seconds);
    ImGui::NewFrame();
}

void imgui_end(view_app *a)
{
    ImGui::Render();
    if (!a->lazy) {
        draw(a);
    }
}

void view_panels_draw(view_app *a)
{
    draw(a);
}
