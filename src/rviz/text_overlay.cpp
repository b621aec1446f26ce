#include "src/rviz/text_overlay.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgrePass.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <Overlay/OgreOverlay.h>
#include <Overlay/OgreOverlayManager.h>
#include <Overlay/OgrePanelOverlayElement.h>

#include <QFont>
#include <QFontMetrics>
#include <QImage>
#include <QPainter>
#include <algorithm>

#include "src/rviz/fiber_colors.hpp"

namespace fiber_proximity_rviz {
namespace {

using Corner = TextOverlay::Corner;
using fiber_proximity_ros::LegendLine;

constexpr int window_margin = 12;  // [pixels] from the window's edges
constexpr int padding = 6;         // [pixels] of the texts from their ground's edges

/// The lines before a ground that is dark enough to read them whatever is behind.
QImage paint(const std::vector<LegendLine>& lines, int height) {
  QFont font("Sans");
  font.setPixelSize(height);
  const QFontMetrics metrics(font);
  int width = 1;
  for (const LegendLine& line : lines) {
    width = std::max(width, metrics.boundingRect(QString::fromStdString(line.text)).width());
  }
  const int step = metrics.lineSpacing();
  // Ogre's hardware textures need no powers of 2.
  QImage image(width + 2 * padding + 2, step * static_cast<int>(lines.size()) + 2 * padding,
               QImage::Format_ARGB32);
  image.fill(QColor(10, 12, 16, 170));
  QPainter painter(&image);
  painter.setRenderHint(QPainter::TextAntialiasing);
  painter.setFont(font);
  int base = padding + metrics.ascent();
  for (const LegendLine& line : lines) {
    const Color color = to_color(line.color, 1.0F);
    painter.setPen(QColor(color[0], color[1], color[2]));
    painter.drawText(padding, base, QString::fromStdString(line.text));
    base += step;
  }
  return image;
}

void align_panel(Corner corner, int width, int height, Ogre::PanelOverlayElement& panel) {
  const bool is_left = corner == Corner::bottom_left || corner == Corner::top_left;
  const bool is_top = corner == Corner::top_left || corner == Corner::top_right;
  panel.setHorizontalAlignment(is_left ? Ogre::GHA_LEFT : Ogre::GHA_RIGHT);
  panel.setVerticalAlignment(is_top ? Ogre::GVA_TOP : Ogre::GVA_BOTTOM);
  const auto at = [](bool is_near, int size) {
    return static_cast<Ogre::Real>(is_near ? window_margin : -window_margin - size);
  };
  panel.setPosition(at(is_left, width), at(is_top, height));
  panel.setDimensions(static_cast<Ogre::Real>(width), static_cast<Ogre::Real>(height));
}

const std::string& text_group() { return Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME; }

/// Removes a texture by name; those who still show it keep it.
void remove_texture(const std::string& name) {
  if (!name.empty()) {
    Ogre::TextureManager::getSingleton().remove(name);
  }
}

}  // namespace

TextOverlay::TextOverlay() {
  static int count = 0;  // rviz makes displays in one thread
  name_ = "fiber_proximity_text_" + std::to_string(count++);
  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  overlay_ = overlays.create(name_);
  panel_ = static_cast<Ogre::PanelOverlayElement*>(overlays.createOverlayElement("Panel", name_));
  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  const Ogre::MaterialPtr material =
      Ogre::MaterialManager::getSingleton().create(name_, text_group());
  Ogre::Pass& pass = *material->getTechnique(0)->getPass(0);
  pass.createTextureUnitState();
  pass.setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  pass.setDepthCheckEnabled(false);
  pass.setLightingEnabled(false);
  panel_->setMaterialName(name_);
  overlay_->add2D(panel_);
}

TextOverlay::~TextOverlay() {
  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  overlay_->hide();
  overlays.destroy(overlay_);
  overlays.destroyOverlayElement(panel_);
  Ogre::MaterialManager::getSingleton().remove(name_);
  remove_texture(texture_);
}

void TextOverlay::show(const std::vector<LegendLine>& lines, Corner corner, int height) {
  if (lines.empty()) {
    overlay_->hide();
    return;
  }
  QImage image = paint(lines, height);
  Ogre::TextureUnitState& unit = *Ogre::MaterialManager::getSingleton()
                                      .getByName(name_)
                                      ->getTechnique(0)
                                      ->getPass(0)
                                      ->getTextureUnitState(0);
  const std::string name = name_ + "_" + std::to_string(texture_count_++);
  const auto width = static_cast<Ogre::uint32>(image.width());
  const auto rows = static_cast<Ogre::uint32>(image.height());
  const Ogre::TexturePtr texture = Ogre::TextureManager::getSingleton().createManual(
      name, text_group(), Ogre::TEX_TYPE_2D, width, rows, 0, Ogre::PF_A8R8G8B8, Ogre::TU_DEFAULT);
  // Rows of QImage's 32 bit formats lie one behind another.
  texture->getBuffer()->blitFromMemory(
      Ogre::PixelBox(width, rows, 1, Ogre::PF_A8R8G8B8, image.bits()));
  unit.setTextureName(name);
  remove_texture(texture_);
  texture_ = name;
  align_panel(corner, image.width(), image.height(), *panel_);
  overlay_->show();
}

}  // namespace fiber_proximity_rviz
