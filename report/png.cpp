#include <dlfcn.h>
#include <librsvg/rsvg.h>

#include <memory>
#include <stdexcept>

#include "bentaxis/report/picture.h"

namespace bentaxis::report {
namespace {

// librsvg brings forty libraries, which would make every start of the program three times as long:
// it is loaded when the first picture is wanted. What it depends on is found through it.
class Librsvg {
 public:
  Librsvg() : library_(dlopen("librsvg-2.so.2", RTLD_NOW)) {
    if (library_ == nullptr)
      throw std::runtime_error(std::string("PNG needs librsvg: ") + dlerror());
  }
  // A function by its name, of the type that the header gives it.
  template <class Function>
  Function* find(const char* name) const {
    void* const found = dlsym(library_, name);
    if (found == nullptr) throw std::runtime_error(std::string("librsvg lacks ") + name);
    return reinterpret_cast<Function*>(found);
  }

 private:
  void* library_;
};
// Only the type of the function: a mention of it would need the library at the link.
#define BENTAXIS_OF_LIBRSVG(function) librsvg.find<decltype(function)>(#function)

}  // namespace

std::string png_of(const std::string& svg) {
  constexpr double kPixels = 3;  // per pixel of the SVG
  static const Librsvg librsvg;
  static const auto read = BENTAXIS_OF_LIBRSVG(rsvg_handle_new_from_data);
  static const auto size_of = BENTAXIS_OF_LIBRSVG(rsvg_handle_get_intrinsic_size_in_pixels);
  static const auto render = BENTAXIS_OF_LIBRSVG(rsvg_handle_render_document);
  static const auto unref = BENTAXIS_OF_LIBRSVG(g_object_unref);
  static const auto new_surface = BENTAXIS_OF_LIBRSVG(cairo_image_surface_create);
  static const auto destroy_surface = BENTAXIS_OF_LIBRSVG(cairo_surface_destroy);
  static const auto new_cairo = BENTAXIS_OF_LIBRSVG(cairo_create);
  static const auto destroy_cairo = BENTAXIS_OF_LIBRSVG(cairo_destroy);
  static const auto write_png = BENTAXIS_OF_LIBRSVG(cairo_surface_write_to_png_stream);

  const auto fail = [] { throw std::runtime_error("a figure cannot be drawn as PNG"); };
  const std::unique_ptr<RsvgHandle, void (*)(gpointer)> handle(
      read(reinterpret_cast<const guint8*>(svg.data()), svg.size(), nullptr), unref);
  double width = 0, height = 0;
  if (!handle || size_of(handle.get(), &width, &height) == 0) fail();
  const RsvgRectangle area{0, 0, kPixels * width, kPixels * height};
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface(
      new_surface(CAIRO_FORMAT_RGB24, static_cast<int>(area.width), static_cast<int>(area.height)),
      destroy_surface);
  const std::unique_ptr<cairo_t, void (*)(cairo_t*)> cairo(new_cairo(surface.get()), destroy_cairo);
  if (render(handle.get(), cairo.get(), &area, nullptr) == 0) fail();
  std::string png;
  const auto append = [](void* to, const unsigned char* bytes, unsigned int count) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
  };
  if (write_png(surface.get(), append, &png) != CAIRO_STATUS_SUCCESS) fail();
  return png;
}

}  // namespace bentaxis::report
