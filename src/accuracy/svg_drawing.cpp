#include "src/accuracy/svg_drawing.hpp"

#include <cmath>

#include "src/accuracy/number_text.hpp"

namespace fiber {
namespace {

/// A place; a hundredth of a pixel is enough, and keeps files of two machines the same.
std::string place(double pixels) { return rounded_text(0.01 * std::round(100.0 * pixels), 6); }

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + '"';
}

std::string attribute(const char* name, double pixels) { return attribute(name, place(pixels)); }

/// Text as XML has it. Names of files may have bytes that XML does not allow.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c < ' ' || c == '\x7f' ? '?' : c;  // what is not ASCII is negative
    }
  }
  return result;
}

std::string more(const std::string& style) { return style.empty() ? "" : ' ' + style; }

const char* name_of(TextAnchor anchor) {
  switch (anchor) {
    case TextAnchor::START:
      return "start";
    case TextAnchor::MIDDLE:
      return "middle";
    case TextAnchor::END:
      break;
  }
  return "end";
}

}  // namespace

SvgDrawing::SvgDrawing(double width, double height) : width_(width), height_(height) {}

void SvgDrawing::line(double x1, double y1, double x2, double y2, const std::string& colour,
                      const std::string& style) {
  body_ += "<line" + attribute("x1", x1) + attribute("y1", y1) + attribute("x2", x2) +
           attribute("y2", y2) + attribute("stroke", colour) + more(style) + "/>\n";
}

void SvgDrawing::rectangle(double x, double y, double width, double height, const std::string& fill,
                           const std::string& stroke) {
  body_ += "<rect" + attribute("x", x) + attribute("y", y) + attribute("width", width) +
           attribute("height", height) + attribute("fill", fill) + attribute("stroke", stroke) +
           "/>\n";
}

void SvgDrawing::circle(double x, double y, double radius, const std::string& fill,
                        const std::string& style) {
  body_ += "<circle" + attribute("cx", x) + attribute("cy", y) + attribute("r", radius) +
           attribute("fill", fill) + more(style) + "/>\n";
}

void SvgDrawing::polygon(const std::string& points, const std::string& fill,
                         const std::string& style) {
  body_ +=
      "<polygon" + attribute("points", points) + attribute("fill", fill) + more(style) + "/>\n";
}

void SvgDrawing::text(double x, double y, const std::string& text, TextAnchor anchor,
                      const std::string& style) {
  body_ += "<text" + attribute("x", x) + attribute("y", y) +
           attribute("text-anchor", name_of(anchor)) + more(style) + '>' + escaped(text) +
           "</text>\n";
}

void SvgDrawing::begin_group(const std::string& title, const std::string& style) {
  body_ += "<g" + more(style) + "><title>" + escaped(title) + "</title>\n";
}

std::string SvgDrawing::document() const {
  const std::string size = place(width_) + ' ' + place(height_);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<svg xmlns=\"http://www.w3.org/2000/svg\"" +
         attribute("width", width_) + attribute("height", height_) +
         attribute("viewBox", "0 0 " + size) +
         " font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"12\">\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n" +
         body_ + "</svg>\n";
}

}  // namespace fiber
