#pragma once

#include <string>

namespace fiber {

/// Where a text begins, ends or has its middle.
enum class TextAnchor { START, MIDDLE, END };

/// A drawing as SVG, made piece by piece; places are in pixels from the upper left corner.
class SvgDrawing {
 public:
  SvgDrawing(double width, double height);

  /// @param colour as CSS has it
  /// @param style  more attributes, as `stroke-dasharray="4 3"`
  void line(double x1, double y1, double x2, double y2, const std::string& colour,
            const std::string& style = "");
  void rectangle(double x, double y, double width, double height, const std::string& fill,
                 const std::string& stroke = "none");
  void circle(double x, double y, double radius, const std::string& fill,
              const std::string& style = "");
  /// A shape of straight sides; points as "x,y x,y …".
  void polygon(const std::string& points, const std::string& fill, const std::string& style = "");
  void text(double x, double y, const std::string& text, TextAnchor anchor = TextAnchor::START,
            const std::string& style = "");

  /// Begins a group that a title names, which browsers show beside the mouse.
  void begin_group(const std::string& title, const std::string& style = "");
  void end_group() { body_ += "</g>\n"; }

  /// The whole file.
  std::string document() const;

 private:
  double width_;
  double height_;
  std::string body_;
};

}  // namespace fiber
