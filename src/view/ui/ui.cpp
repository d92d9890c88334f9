/* ui.cpp - ui.h on Dear ImGui 1.86; the only C++ file of the window */
#include "view/ui/ui.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <unordered_map>
#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h> /* for the numbers of keys */
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <imgui_internal.h> /* navigation and the state of widgets */

namespace {

struct Ui {
    float scale = 1.0f;
    UiClipboard clipboard = {};
    std::string scope; /* "Material/", before a label */
    std::vector<size_t> scopes;
    std::vector<UiControl> shown, last;
    std::string reveal;
    std::vector<std::string> panels;         /* of this frame, in their order */
    std::string panel;                       /* panel with the keyboard; "": none */
    bool to_menus = false, to_panel = false; /* moves the keyboard there in the next frame */
    bool navigates = false;
    bool leaves_room = false;                /* the next label leaves it for a small button */
    bool noted = false;                      /* the previous widget is the last control recorded */
    bool searches = false, searched = false; /* the field of ui_search is edited; and was, a frame ago */
    ImDrawList *list = nullptr;              /* target of drawing; NULL: the current window's */
    ImVec4 accent = ImVec4(0.86f, 0.55f, 0.30f, 1.0f);
};

Ui *ui;

const float names_share = 0.45f; /* of the width, for the column of names */

ImDrawList *canvas() { return ui->list ? ui->list : ImGui::GetWindowDrawList(); }

ImVec2 at(float x, float y) { return ImVec2(x, y); }

const char *clipboard_get(void *user) {
    const UiClipboard *c = static_cast<const UiClipboard *>(user);
    return c->get ? c->get(c->user) : "";
}

void clipboard_set(void *user, const char *text) {
    const UiClipboard *c = static_cast<const UiClipboard *>(user);
    if (c->set) c->set(c->user, text);
}

/* Returns the part of a label that is shown. */
std::string visible(const char *label) {
    const char *end = strstr(label, "##");
    return end ? std::string(label, end) : std::string(label);
}

/* Returns the name that a label gives a control. */
std::string called(const char *label) {
    const char *hidden = strstr(label, "##"), *own = strstr(label, "###");
    return own ? own + 3 : hidden == label ? label + 2 : visible(label);
}

/* Records the previous widget under its name. */
void note(const char *label) {
    ui->noted = false;
    UiControl control = {};
    std::string name = ui->scope + called(label);
    snprintf(control.name, sizeof control.name, "%s", name.c_str());
    ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    control.box = {low.x, low.y, high.x - low.x, high.y - low.y};
    if (!ui->reveal.empty() && name == ui->reveal) {
        ImGui::SetScrollHereY(0.5f);
        ui->reveal.clear();
    }
    ImVec2 middle = at(0.5f * (low.x + high.x), 0.5f * (low.y + high.y)); /* a script points there */
    if (ImGui::IsRectVisible(middle, at(middle.x + 1.0f, middle.y + 1.0f))) {
        ui->shown.push_back(control);
        ui->noted = true;
    }
}

/* Works as note, for a control whose label shows its whole state: a heading, a line of a menu, a file. */
void note_spoken(const char *label) {
    note(label);
    if (ui->noted) ui->shown.back().explained = true;
}

/* Records the panel or window that has begun, and gives it the keyboard if it is its turn. */
void note_panel(const char *name) {
    ui->panels.push_back(name);
    if (!ui->to_panel || ui->panel != name) return;
    ui->to_panel = false;
    ImGui::FocusWindow(ImGui::GetCurrentWindow());
    ImGui::NavInitWindow(ImGui::GetCurrentWindow(), true);
    GImGui->NavDisableHighlight = false;
}

float dots_width() { return ImGui::CalcTextSize("...").x + 2.0f * ImGui::GetStyle().FramePadding.x; }

void show_tip(const char *text, unsigned texture, float side) {
    ImGui::BeginTooltip();
    if (texture) ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<size_t>(texture)), at(side, side));
    const float widest = 0.6f * ImGui::GetIO().DisplaySize.x;
    ImGui::PushTextWrapPos(std::fmin(36.0f * ImGui::GetFontSize(), widest));
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

/* Shortens a text, which is UTF-8, to a width; an ellipsis marks that it is. */
std::string shortened(const std::string &text, float width) {
    std::string part = text;
    if (ImGui::CalcTextSize(part.c_str()).x <= width) return part;
    while (!part.empty() && ImGui::CalcTextSize((part + "\u2026").c_str()).x > width) {
        while (!part.empty() && (part.back() & 0xC0) == 0x80) part.pop_back();
        if (!part.empty()) part.pop_back();
    }
    return part + "\u2026";
}

/* Labels stand left of widgets: a column of names, one of values. A name that is too long is shortened, and shown in full
 * where the mouse rests on it. */
void labelled(const char *label) {
    float left = names_share * ImGui::GetWindowContentRegionMax().x;
    std::string text = visible(label);
    if (text.empty()) {
        ImGui::SetNextItemWidth(-1.0f);
        return;
    }
    const float gap = ImGui::GetStyle().ItemSpacing.x, room = left - ImGui::GetCursorPosX() - 0.75f * gap;
    const std::string part = shortened(text, ui->leaves_room ? room - dots_width() : room);
    ui->leaves_room = false;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(part.c_str());
    if (part != text && ImGui::IsItemHovered() && !ImGui::IsMouseDown(0)) show_tip(text.c_str(), 0, 0.0f);
    ImGui::SameLine(left);
    ImGui::SetNextItemWidth(-1.0f);
}

std::string hidden(const char *label) { return std::string("##") + label; }

void set_style(float scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle &s = ImGui::GetStyle();
    s.WindowRounding = 0.0f;
    s.FrameRounding = 3.0f;
    s.GrabRounding = 3.0f;
    s.PopupRounding = 4.0f;
    s.ScrollbarRounding = 4.0f;
    s.WindowBorderSize = 0.0f;
    s.WindowPadding = at(10, 8);
    s.FramePadding = at(6, 3);
    s.ItemSpacing = at(6, 5);
    s.ScrollbarSize = 11.0f;
    s.GrabMinSize = 9.0f;
    s.AntiAliasedFill = true;
    s.ScaleAllSizes(scale);
    ImVec4 *c = s.Colors;
    const ImVec4 accent = ui->accent;
    auto faint = [&](float a) { return ImVec4(accent.x, accent.y, accent.z, a); };
    c[ImGuiCol_Text] = ImVec4(0.90f, 0.90f, 0.88f, 1.0f);
    c[ImGuiCol_TextDisabled] = ImVec4(0.56f, 0.57f, 0.58f, 1.0f);
    c[ImGuiCol_WindowBg] = ImVec4(0.125f, 0.13f, 0.14f, 1.0f);
    c[ImGuiCol_PopupBg] = ImVec4(0.10f, 0.105f, 0.115f, 0.98f);
    c[ImGuiCol_MenuBarBg] = ImVec4(0.105f, 0.11f, 0.12f, 1.0f);
    c[ImGuiCol_FrameBg] = ImVec4(0.20f, 0.21f, 0.225f, 1.0f);
    c[ImGuiCol_FrameBgHovered] = ImVec4(0.25f, 0.26f, 0.28f, 1.0f);
    c[ImGuiCol_FrameBgActive] = ImVec4(0.28f, 0.29f, 0.31f, 1.0f);
    c[ImGuiCol_Button] = ImVec4(0.22f, 0.23f, 0.25f, 1.0f);
    c[ImGuiCol_ButtonHovered] = faint(0.45f);
    c[ImGuiCol_ButtonActive] = faint(0.70f);
    c[ImGuiCol_Header] = ImVec4(0.18f, 0.19f, 0.205f, 1.0f);
    c[ImGuiCol_HeaderHovered] = faint(0.35f);
    c[ImGuiCol_HeaderActive] = faint(0.55f);
    c[ImGuiCol_SliderGrab] = faint(0.85f);
    c[ImGuiCol_SliderGrabActive] = accent;
    c[ImGuiCol_CheckMark] = accent;
    c[ImGuiCol_Separator] = ImVec4(0.24f, 0.25f, 0.27f, 1.0f);
    c[ImGuiCol_Border] = ImVec4(0.26f, 0.27f, 0.29f, 1.0f);
    c[ImGuiCol_PlotHistogram] = accent;
    c[ImGuiCol_TextSelectedBg] = faint(0.40f);
    c[ImGuiCol_NavHighlight] = faint(0.9f);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_MenuBarBg];
    c[ImGuiCol_TitleBgCollapsed] = c[ImGuiCol_MenuBarBg];
    c[ImGuiCol_ResizeGrip] = faint(0.2f);
    c[ImGuiCol_ModalWindowDimBg] = ImVec4(0.0f, 0.0f, 0.0f, 0.45f);
}

void set_font(float scale) {
    static const ImWchar ranges[] = {0x20,   0x17F,  0x370,  0x3FF,  0x2010, 0x2027, 0x2070,
                                     0x209C, 0x2190, 0x21FF, 0x2200, 0x22FF, 0};
    ImGuiIO &io = ImGui::GetIO();
    FILE *file = fopen(WEFT_FONT, "rb");
    if (file) {
        fclose(file);
        io.Fonts->AddFontFromFileTTF(WEFT_FONT, std::floor(13.5f * scale), nullptr, ranges);
        return;
    }
    ImFontConfig config;
    config.SizePixels = std::floor(13.0f * scale);
    io.Fonts->AddFontDefault(&config);
}

void set_keys(ImGuiIO &io) {
    static const int pairs[][2] = {{ImGuiKey_Tab, GLFW_KEY_TAB},
                                   {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                   {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                   {ImGuiKey_UpArrow, GLFW_KEY_UP},
                                   {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                                   {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
                                   {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
                                   {ImGuiKey_Home, GLFW_KEY_HOME},
                                   {ImGuiKey_End, GLFW_KEY_END},
                                   {ImGuiKey_Insert, GLFW_KEY_INSERT},
                                   {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                   {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                   {ImGuiKey_Space, GLFW_KEY_SPACE},
                                   {ImGuiKey_Enter, GLFW_KEY_ENTER},
                                   {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                   {ImGuiKey_KeyPadEnter, GLFW_KEY_KP_ENTER},
                                   {ImGuiKey_A, GLFW_KEY_A},
                                   {ImGuiKey_C, GLFW_KEY_C},
                                   {ImGuiKey_V, GLFW_KEY_V},
                                   {ImGuiKey_X, GLFW_KEY_X},
                                   {ImGuiKey_Y, GLFW_KEY_Y},
                                   {ImGuiKey_Z, GLFW_KEY_Z}};
    for (const auto &pair : pairs) io.KeyMap[pair[0]] = pair[1];
}

} // namespace

bool ui_create(float scale, const UiClipboard *clipboard) {
    ui = new Ui;
    ui->scale = scale;
    if (clipboard) ui->clipboard = *clipboard;
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    io.GetClipboardTextFn = clipboard_get;
    io.SetClipboardTextFn = clipboard_set;
    io.ClipboardUserData = &ui->clipboard;
    set_keys(io);
    set_font(scale);
    set_style(scale);
    return ImGui_ImplOpenGL3_Init("#version 330 core");
}

void ui_destroy(void) {
    if (!ui) return;
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
    delete ui;
    ui = nullptr;
}

void ui_begin(const UiInput *input) {
    ImGuiIO &io = ImGui::GetIO();
    io.DisplaySize = at(static_cast<float>(input->width), static_cast<float>(input->height));
    io.DeltaTime = input->seconds > 1e-5f ? input->seconds : 1e-5f;
    io.MousePos = input->x < 0.0f && input->y < 0.0f ? at(-FLT_MAX, -FLT_MAX) : at(input->x, input->y);
    for (int k = 0; k < UI_BUTTONS; k++) io.MouseDown[k] = input->button[k];
    io.MouseWheel = input->wheel;
    io.MouseWheelH = input->wheel_across;
    for (int k = 0; k < UI_KEYS; k++) io.KeysDown[k] = input->key[k];
    if (!io.WantTextInput) io.KeysDown[GLFW_KEY_TAB] = false; /* used by the window, except while text is typed */
    io.KeyCtrl = input->control;
    io.KeyShift = input->shift;
    io.KeyAlt = input->alt;
    for (int k = 0; k < input->typed_count; k++) io.AddInputCharacter(input->typed[k]);
    /* Escape and the arrows go to a popup, or to a panel that has the keyboard. */
    bool popup = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    bool leaves = input->button[0] || input->button[1] || (input->key[GLFW_KEY_ESCAPE] && !popup);
    if (ui->navigates && leaves && !io.WantTextInput) {
        ui->navigates = false;
        ui->panel.clear();
        ImGui::SetWindowFocus(nullptr);
    }
    io.ConfigFlags = popup || ui->navigates ? ImGuiConfigFlags_NavEnableKeyboard : 0;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    ui->panels.clear();
    ui->searched = ui->searches;
    ui->searches = false;
    ui->last.swap(ui->shown);
    ui->shown.clear();
    ui->list = nullptr;
}

void ui_end(void) {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    ui->last = ui->shown;
}

bool ui_wants_mouse(void) { return ImGui::GetIO().WantCaptureMouse; }
bool ui_wants_keys(void) { return ImGui::GetIO().WantTextInput || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup); }
bool ui_types(void) { return ImGui::GetIO().WantTextInput; }

void ui_go_to_menus(void) { ui->navigates = ui->to_menus = true; }
void ui_go_to_next_panel(void) {
    size_t k = 0;
    while (k < ui->panels.size() && ui->panels[k] != ui->panel) k++;
    k = ui->panel.empty() ? 0 : k + 1;
    ui->panel = k < ui->panels.size() ? ui->panels[k] : "";
    ui->navigates = ui->to_panel = !ui->panel.empty();
    if (!ui->navigates) ImGui::SetWindowFocus(nullptr);
}

UiCursor ui_cursor(void) {
    switch (ImGui::GetMouseCursor()) {
    case ImGuiMouseCursor_TextInput: return UI_BEAM;
    case ImGuiMouseCursor_ResizeEW: return UI_ACROSS;
    case ImGuiMouseCursor_Hand: return UI_HAND;
    default: return UI_ARROW;
    }
}

float ui_scale(void) { return ui->scale; }
float ui_line_height(void) { return ImGui::GetFrameHeightWithSpacing(); }
float ui_text_width(const char *text) { return ImGui::CalcTextSize(text).x; }
float ui_width_left(void) { return ImGui::GetContentRegionAvail().x; }
float ui_height_left(void) { return ImGui::GetContentRegionAvail().y; }

bool ui_panel(const char *name, UiBox box, bool scrolls) {
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                             ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus |
                             ImGuiWindowFlags_NoSavedSettings;
    if (!scrolls)
        flags |= ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
    else
        flags |= ImGuiWindowFlags_AlwaysVerticalScrollbar; /* so that the width does not change with the length */
    ImGui::SetNextWindowPos(at(box.x, box.y));
    ImGui::SetNextWindowSize(at(box.width, box.height));
    bool shown = ImGui::Begin(name, nullptr, flags);
    note_panel(name);
    return shown;
}
void ui_panel_end(void) { ImGui::End(); }

bool ui_window(const char *name, UiBox first, bool *open) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float width = std::fmin(first.width, screen.x - 20.0f), height = std::fmin(first.height, screen.y - 20.0f);
    ImGui::SetNextWindowPos(
        at(std::fmin(first.x, screen.x - width - 10.0f), std::fmin(first.y, screen.y - height - 10.0f)),
        ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(at(width, height), ImGuiCond_FirstUseEver);
    bool shown = ImGui::Begin(name, open, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
    note_panel(name);
    return shown;
}
void ui_window_end(void) { ImGui::End(); }

void ui_dialog_open(const char *name) { ImGui::OpenPopup(name); }
bool ui_dialog(const char *name, float width, float height) {
    ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(at(0.5f * screen.x, 0.5f * screen.y), ImGuiCond_Always, at(0.5f, 0.5f));
    ImGui::SetNextWindowSize(
        at(std::fmin(width, screen.x - 20.0f), height > 0.0f ? std::fmin(height, screen.y - 20.0f) : 0.0f));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
    bool shown = ImGui::BeginPopupModal(
        name, nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    ImGui::PopStyleVar();
    return shown;
}
bool ui_escaped(void) {
    return (!ImGui::GetIO().WantTextInput || ui->searched) && ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false);
}
void ui_dialog_close(void) { ImGui::CloseCurrentPopup(); }
void ui_dialog_end(void) { ImGui::EndPopup(); }

bool ui_list(const char *name, float width, float height) { return ImGui::BeginChild(name, at(width, height), true); }
void ui_list_end(void) { ImGui::EndChild(); }

void ui_scope(const char *name) {
    ui->scopes.push_back(ui->scope.size());
    ui->scope += called(name) + "/";
    ImGui::PushID(name);
}
void ui_scope_end(void) {
    ui->scope.resize(ui->scopes.back());
    ui->scopes.pop_back();
    ImGui::PopID();
}

bool ui_section(const char *label, bool unfolded) {
    bool open = ImGui::CollapsingHeader(label, unfolded ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    note_spoken(label);
    return open;
}

bool ui_fold(const char *label) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    bool open = ImGui::TreeNodeEx(label, ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_SpanAvailWidth);
    ImGui::PopStyleColor();
    note_spoken(label);
    return open;
}

bool ui_menu_bar(void) {
    bool shown = ImGui::BeginMainMenuBar();
    if (!shown || !ui->to_menus) return shown;
    ui->to_menus = false;
    ImGui::FocusWindow(ImGui::GetCurrentWindow());
    ImGui::SetNavID(ImGui::GetID("File"), ImGuiNavLayer_Menu, 0, ImRect());
    GImGui->NavDisableHighlight = false;
    return shown;
}
void ui_menu_bar_end(void) { ImGui::EndMainMenuBar(); }
bool ui_menu(const char *label) {
    bool open = ImGui::BeginMenu(label);
    note_spoken(label);
    if (open) ui_scope(label);
    return open;
}
void ui_menu_end(void) {
    ui_scope_end();
    ImGui::EndMenu();
}
bool ui_menu_item(const char *label, const char *shortcut, bool checked, bool enabled) {
    bool chosen = ImGui::MenuItem(label, shortcut, checked, enabled);
    note_spoken(label);
    return chosen;
}

void ui_same_line(void) { ImGui::SameLine(); }
void ui_column(float fraction) { ImGui::SameLine(fraction * ImGui::GetWindowContentRegionMax().x); }
void ui_leave_room(void) { ui->leaves_room = true; }
void ui_beside(void) {
    ImGui::SameLine(names_share * ImGui::GetWindowContentRegionMax().x - dots_width() -
                    0.5f * ImGui::GetStyle().ItemSpacing.x);
}
void ui_rule(void) { ImGui::Separator(); }
void ui_disabled(bool disabled) { ImGui::BeginDisabled(disabled); }
void ui_disabled_end(void) { ImGui::EndDisabled(); }
void ui_faint(bool faint) { ImGui::PushStyleVar(ImGuiStyleVar_Alpha, faint ? 0.42f : 1.0f); }
void ui_faint_end(void) { ImGui::PopStyleVar(); }
void ui_indent(void) {
    ImGui::Indent(names_share * ImGui::GetWindowContentRegionMax().x - ImGui::GetStyle().WindowPadding.x);
}
void ui_indent_end(void) {
    ImGui::Unindent(names_share * ImGui::GetWindowContentRegionMax().x - ImGui::GetStyle().WindowPadding.x);
}

void ui_text(const char *text) { ImGui::TextUnformatted(text); }
void ui_wrapped(const char *text) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
}
void ui_dim(const char *text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ui_wrapped(text);
    ImGui::PopStyleColor();
}
void ui_warning(const char *text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.98f, 0.78f, 0.35f, 1.0f));
    ui_wrapped(text);
    ImGui::PopStyleColor();
}

void ui_tip(const char *text) { ui_tip_picture(text, 0, 0.0f); }
void ui_tip_picture(const char *text, unsigned texture, float side) {
    if (text && *text && ui->noted) ui->shown.back().explained = true;
    if (!text || !*text || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    if (!ImGui::IsMouseDown(0)) show_tip(text, texture, side);
}

bool ui_button(const char *label) {
    bool pressed = ImGui::Button(label);
    note(label);
    return pressed;
}

bool ui_small_button(const char *label) {
    bool pressed = ImGui::SmallButton(label);
    note(label);
    return pressed;
}

bool ui_checkbox(const char *label, bool *on) {
    bool changed = ImGui::Checkbox(label, on);
    note(label);
    return changed;
}

bool ui_tabs(const char *label, const char *const *names, const char *const *tips, int *chosen) {
    bool changed = false;
    ui_scope(label);
    for (int k = 0; names[k]; k++) {
        if (k) ImGui::SameLine(0.0f, 1.0f);
        bool is = *chosen == k;
        if (is) {
            ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(ui->accent.x, ui->accent.y, ui->accent.z, 0.75f));
            ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 1.0f, 1.0f, 1.0f));
        }
        if (ImGui::Button(names[k]) && !is) {
            *chosen = k;
            changed = true;
        }
        note(names[k]);
        if (is) ImGui::PopStyleColor(2);
        ui_tip(tips[k]);
    }
    ui_scope_end();
    return changed;
}

bool ui_selectable(const char *label, bool chosen) {
    bool pressed = ImGui::Selectable(label, chosen, ImGuiSelectableFlags_DontClosePopups);
    note_spoken(label);
    return pressed;
}

int ui_row(const char *label, bool chosen) {
    bool pressed =
        ImGui::Selectable(label, chosen, ImGuiSelectableFlags_DontClosePopups | ImGuiSelectableFlags_AllowDoubleClick);
    note_spoken(label);
    return !pressed ? 0 : ImGui::IsMouseDoubleClicked(0) ? 2 : 1;
}
void ui_scroll_here(void) { ImGui::SetScrollHereY(0.5f); }
bool ui_field(const char *label, const char *value) {
    labelled(label);
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_FrameBg));
    ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, at(0.0f, 0.5f));
    bool pressed = ImGui::Button((std::string(value) + "###" + label).c_str(), at(-1.0f, 0.0f));
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
    note(label);
    return pressed;
}

bool ui_tile(const char *label, unsigned texture, float side, const char *caption, bool chosen) {
    const ImVec2 low = ImGui::GetCursorScreenPos(), high = at(low.x + side, low.y + side);
    const float line = ImGui::GetTextLineHeight(), gap = 2.0f * ui->scale;
    bool pressed = ImGui::InvisibleButton(label, at(side, side + gap + line));
    note(label);
    ImDrawList *list = ImGui::GetWindowDrawList();
    if (texture)
        list->AddImage(reinterpret_cast<ImTextureID>(static_cast<size_t>(texture)), low, high);
    else
        list->AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg));
    const bool marked = ImGui::IsItemHovered() || ImGui::IsItemFocused();
    if (chosen || marked)
        list->AddRect(low, high, ImGui::GetColorU32(chosen ? ui->accent : ImGui::GetStyleColorVec4(ImGuiCol_Text)),
                      0.0f, 0, 2.0f * ui->scale);
    const ImVec2 text = at(low.x, high.y + gap), end = at(high.x, high.y + gap + line);
    ImGui::PushStyleColor(ImGuiCol_Text,
                          ImGui::GetStyleColorVec4(chosen || marked ? ImGuiCol_Text : ImGuiCol_TextDisabled));
    ImGui::RenderTextEllipsis(list, text, end, end.x, end.x, caption, nullptr, nullptr);
    ImGui::PopStyleColor();
    return pressed;
}

void ui_words_beside(const char *title, const char *words) {
    ImGui::SameLine();
    ImGui::BeginGroup();
    ui_wrapped(title);
    ui_dim(words);
    ImGui::EndGroup();
}

bool ui_will_be_seen(float width, float height) { return ImGui::IsRectVisible(at(width, height)); }

bool ui_choice(const char *label, const UiChoices *choices, int *chosen) {
    bool changed = false;
    labelled(label);
    const char *now = *chosen >= 0 && *chosen < choices->count ? choices->name(choices->user, *chosen) : "";
    bool open = ImGui::BeginCombo(hidden(label).c_str(), now, ImGuiComboFlags_HeightLarge);
    if (!open) {
        note(label);
        if (choices->help && *chosen >= 0 && *chosen < choices->count) ui_tip(choices->help(choices->user, *chosen));
        return false;
    }
    ui_scope(label);
    for (int k = 0; k < choices->count; k++) {
        const char *name = choices->name(choices->user, k);
        ImGui::PushID(k);
        if (ImGui::Selectable("##row", k == *chosen)) {
            changed = k != *chosen;
            *chosen = k;
        }
        note_spoken(name);
        if (choices->help) ui_tip(choices->help(choices->user, k));
        ImGui::SameLine(0.0f, 0.0f);
        ImGui::TextUnformatted(name);
        ImGui::PopID();
        if (k == *chosen && ImGui::IsWindowAppearing()) ImGui::SetScrollHereY(0.5f);
    }
    ui_scope_end();
    ImGui::EndCombo();
    note_spoken(label); /* the rows are recorded */
    return changed;
}

bool ui_slider(const char *label, const UiRange *range, float *value) {
    char format[48];
    float span = std::fabs(range->high - range->low);
    int digits = span > 50.0f ? 1 : span > 5.0f ? 2 : 3;
    const char *gap = range->unit ? " " : "", *unit = range->unit ? range->unit : "";
    if (range->logarithmic)
        snprintf(format, sizeof format, "%%.3g%s%s", gap, unit);
    else
        snprintf(format, sizeof format, "%%.%df%s%s", digits, gap, unit);
    labelled(label);
    ImGuiSliderFlags flags = ImGuiSliderFlags_NoRoundToFormat;
    if (range->logarithmic) flags |= ImGuiSliderFlags_Logarithmic;
    const float before = *value, number = 5.2f * ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
    ImGui::SetNextItemWidth(std::fmax(width - number, 0.4f * width));
    ImGuiID id = ImGui::GetID(hidden(label).c_str());
    bool typed = ImGui::TempInputIsActive(id) || GImGui->NavActivateInputId == id ||
                 (ImGui::GetIO().KeyCtrl && GImGui->HoveredIdPreviousFrame == id);
    bool changed =
        ImGui::SliderFloat(hidden(label).c_str(), value, range->low, range->high, typed ? format : "", flags);
    if (!std::isfinite(*value)) *value = before; /* typed */
    note(label);
    char shown[48];
    snprintf(shown, sizeof shown, format, static_cast<double>(*value));
    ImVec2 end = ImGui::GetItemRectMax();
    ImGui::GetWindowDrawList()->AddText(
        at(end.x + 0.4f * ImGui::GetFontSize(), ImGui::GetItemRectMin().y + ImGui::GetStyle().FramePadding.y),
        ImGui::GetColorU32(ImGuiCol_Text), shown); /* beside the handle, which would hide it */
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0) && !ImGui::GetIO().KeyCtrl) {
        changed = *value < range->initial || *value > range->initial;
        *value = range->initial;
        ImGui::ClearActiveID(); /* else the mouse, which is still down, moves it */
    }
    return changed;
}

bool ui_slider_int(const char *label, int low, int high, int *value) {
    labelled(label);
    bool changed = ImGui::SliderInt(hidden(label).c_str(), value, low, high);
    note(label);
    return changed;
}

bool ui_numbers(const char *label, float step, float *values, int count) {
    const std::vector<float> before(values, values + count);
    labelled(label);
    bool changed =
        ImGui::DragScalarN(hidden(label).c_str(), ImGuiDataType_Float, values, count, step, nullptr, nullptr, "%.3g");
    for (int k = 0; k < count; k++)
        if (!(std::fabs(values[k]) <= 1e6f)) values[k] = before[static_cast<size_t>(k)];
    note(label);
    return changed;
}

static float encoded(float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f; }
static float decoded(float x) { return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f); }

bool ui_color(const char *label, const float initial[3], float color[3]) {
    float most = std::fmax(1.0f, std::fmax(color[0], std::fmax(color[1], color[2]))), shown[3];
    for (int c = 0; c < 3; c++) shown[c] = encoded(color[c] / most);
    const float before[3] = {color[0], color[1], color[2]};
    labelled(label);
    float side = ImGui::GetFrameHeight();
    bool swatch = ImGui::ColorEdit3(hidden(label).c_str(), shown,
                                    ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel |
                                        ImGuiColorEditFlags_PickerHueWheel | ImGuiColorEditFlags_NoTooltip);
    if (swatch)
        for (int c = 0; c < 3; c++) color[c] = most * decoded(shown[c]);
    ImGui::SameLine(0.0f, 0.25f * side);
    ImGui::SetNextItemWidth(-1.0f);
    bool typed = ImGui::DragFloat3((hidden(label) + "3").c_str(), color, 0.003f, 0.0f, FLT_MAX, "%.3f",
                                   ImGuiSliderFlags_NoRoundToFormat);
    for (int c = 0; c < 3; c++)
        if (!(color[c] >= 0.0f && color[c] <= 1e6f)) color[c] = before[c];
    note(label);
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(1) && initial) {
        for (int c = 0; c < 3; c++) color[c] = initial[c];
        return true;
    }
    return swatch || typed;
}

static ImVec4 shown_of(const float color[3]) {
    return ImVec4(encoded(color[0]), encoded(color[1]), encoded(color[2]), 1.0f);
}

float ui_linear(float shown) { return decoded(shown); }
unsigned ui_shown(const float color[3]) { return ImGui::ColorConvertFloat4ToU32(shown_of(color)); }

bool ui_swatch(const char *label, const float color[3]) {
    float side = 1.1f * ImGui::GetFontSize();
    bool pressed = ImGui::ColorButton(label, shown_of(color),
                                      ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop, at(side, side));
    note(label);
    return pressed;
}

bool ui_input(const char *label, char *text, int size) {
    labelled(label);
    bool entered =
        ImGui::InputText(hidden(label).c_str(), text, static_cast<size_t>(size), ImGuiInputTextFlags_EnterReturnsTrue);
    note(label);
    return entered;
}

bool ui_input_path(const char *label, char *text, int size) {
    labelled(label);
    bool entered = ImGui::InputText(hidden(label).c_str(), text, static_cast<size_t>(size),
                                    ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    note(label);
    return entered;
}

static int on_arrow(ImGuiInputTextCallbackData *data) {
    int *step = static_cast<int *>(data->UserData);
    *step = data->EventKey == ImGuiKey_UpArrow ? -1 : 1;
    return 0;
}

bool ui_search(const char *label, const char *hint, char *text, int size, bool focus, int *step) {
    *step = 0;
    ImGui::SetNextItemWidth(-1.0f);
    if (focus || ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    bool entered = ImGui::InputTextWithHint(hidden(label).c_str(), hint, text, static_cast<size_t>(size),
                                            ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory,
                                            on_arrow, step);
    ui->searches = ImGui::IsItemActive();
    note(label);
    return entered;
}

void ui_progress(float fraction, const char *text) {
    float phase = static_cast<float>(std::fmod(ImGui::GetTime(), 1.0));
    ImGui::ProgressBar(fraction >= 0.0f ? fraction : phase, at(-1.0f, 0.0f), text);
}

bool ui_canvas(const char *label, float width, float height, UiBox *box) {
    if (width <= 0.0f) width = ImGui::GetContentRegionAvail().x;
    ImVec2 p = ImGui::GetCursorScreenPos();
    *box = {p.x, p.y, width, height};
    ImGui::InvisibleButton(label, at(std::fmax(width, 1.0f), std::fmax(height, 1.0f)));
    note(label);
    return ImGui::IsItemHovered() || ImGui::IsItemActive();
}

void ui_behind(bool behind) { ui->list = behind ? ImGui::GetBackgroundDrawList() : nullptr; }
void ui_clip(const UiBox *box) {
    if (box)
        canvas()->PushClipRect(at(box->x, box->y), at(box->x + box->width, box->y + box->height), true);
    else
        canvas()->PopClipRect();
}
void ui_line(float x0, float y0, float x1, float y1, unsigned color, float thickness) {
    canvas()->AddLine(at(x0, y0), at(x1, y1), color, thickness);
}
void ui_curve(const float *xy, int count, unsigned color, float thickness) {
    std::vector<ImVec2> points;
    points.reserve(static_cast<size_t>(count));
    for (int k = 0; k < count; k++) points.push_back(at(xy[2 * k], xy[2 * k + 1]));
    canvas()->AddPolyline(points.data(), count, color, 0, thickness);
}
void ui_fill(UiBox b, unsigned color) {
    canvas()->AddRectFilled(at(b.x, b.y), at(b.x + b.width, b.y + b.height), color);
}
void ui_triangle(const float xy[6], unsigned color) {
    canvas()->AddTriangleFilled(at(xy[0], xy[1]), at(xy[2], xy[3]), at(xy[4], xy[5]), color);
}
void ui_disc(float x, float y, float radius, unsigned color) { canvas()->AddCircleFilled(at(x, y), radius, color); }
void ui_ring(float x, float y, float radius, unsigned color) {
    canvas()->AddCircle(at(x, y), radius, color, 0, 1.5f * ui->scale);
}
void ui_label(float x, float y, unsigned color, const char *text) { canvas()->AddText(at(x, y), color, text); }
void ui_picture(unsigned texture, UiBox b, bool flipped) {
    ui_picture_part(texture, b, 0.0f, flipped ? 1.0f : 0.0f, 1.0f, flipped ? 0.0f : 1.0f);
}
void ui_picture_faint(unsigned texture, UiBox b, bool flipped, float opacity) {
    canvas()->AddImage(reinterpret_cast<ImTextureID>(static_cast<size_t>(texture)), at(b.x, b.y),
                       at(b.x + b.width, b.y + b.height), at(0.0f, flipped ? 1.0f : 0.0f),
                       at(1.0f, flipped ? 0.0f : 1.0f),
                       ImGui::ColorConvertFloat4ToU32(ImVec4(1.0f, 1.0f, 1.0f, opacity)));
}
void ui_picture_part(unsigned texture, UiBox b, float u0, float v0, float u1, float v1) {
    canvas()->AddImage(reinterpret_cast<ImTextureID>(static_cast<size_t>(texture)), at(b.x, b.y),
                       at(b.x + b.width, b.y + b.height), at(u0, v0), at(u1, v1));
}

int ui_control_count(void) { return static_cast<int>(ui->last.size()); }
const UiControl *ui_control(int index) { return &ui->last[static_cast<size_t>(index)]; }
const UiControl *ui_control_find(const char *name) {
    for (const UiControl &c : ui->last)
        if (strcmp(c.name, name) == 0) return &c;
    return nullptr;
}
void ui_reveal(const char *name) { ui->reveal = name; }
