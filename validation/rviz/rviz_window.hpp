#pragma once

#include <OgreRenderWindow.h>
#include <ros/init.h>
#include <rviz/display.h>
#include <rviz/display_group.h>
#include <rviz/properties/status_list.h>
#include <rviz/properties/status_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>
#include <rviz/yaml_config_reader.h>

#include <Eigen/Core>
#include <QApplication>
#include <QElapsedTimer>
#include <QImage>
#include <QPixmap>
#include <QScreen>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

/// rviz without its panels, in the test's own process.
namespace rviz_test {

using Pixel = std::array<std::uint8_t, 3>;

struct Status {
  int level = -1;  // rviz::StatusProperty::Level; -1: there is none
  std::string text;
};

class RvizWindow {
 public:
  /// The window looks from a distance of 3 m at the origin of the frame `world`.
  /// @param width,height in pixels
  explicit RvizWindow(int width = 400, int height = 300)
      : panel_(std::make_unique<rviz::RenderPanel>()) {
    panel_->resize(width, height);
    panel_->show();
    manager_ = std::make_unique<rviz::VisualizationManager>(panel_.get());
    panel_->initialize(manager_->getSceneManager(), manager_.get());
    manager_->initialize();
    manager_->setFixedFrame("world");
    manager_->getViewManager()->getCurrent()->subProp("Pitch")->setValue(0.8);
    look_at(Eigen::Vector3d::Zero(), 3.0);
    manager_->startUpdate();
  }
  ~RvizWindow() {
    manager_->stopUpdate();
    manager_->removeAllDisplays();
  }
  RvizWindow(const RvizWindow&) = delete;
  RvizWindow& operator=(const RvizWindow&) = delete;

  /// @param distance [m] from there
  void look_at(const Eigen::Vector3d& point, double distance) {
    rviz::ViewController& view = *manager_->getViewManager()->getCurrent();
    view.subProp("Distance")->setValue(distance);
    rviz::Property& focus = *view.subProp("Focal Point");
    focus.subProp("X")->setValue(point.x());
    focus.subProp("Y")->setValue(point.y());
    focus.subProp("Z")->setValue(point.z());
  }

  rviz::ViewController& view() { return *manager_->getViewManager()->getCurrent(); }

  /// Shows what a configuration file says, but in this frame, as `rviz -d FILE -f FRAME` does.
  /// @returns false if the file cannot be read
  bool load(const std::string& file, const std::string& frame) {
    rviz::YamlConfigReader reader;
    rviz::Config config;
    reader.readFile(config, QString::fromStdString(file));
    if (reader.error()) {
      return false;
    }
    manager_->load(config.mapGetChild("Visualization Manager"));
    set_fixed_frame(frame);
    return true;
  }
  void set_fixed_frame(const std::string& frame) {
    manager_->setFixedFrame(QString::fromStdString(frame));
  }

  /// A display made by its class's name, as from a configuration file.
  rviz::Display& add(const char* class_id) {
    return *manager_->createDisplay(class_id, class_id, true);
  }
  /// A display of a configuration file; nullptr if there is none of this name.
  rviz::Display* find(const std::string& name) {
    const rviz::DisplayGroup& all = *manager_->getRootDisplayGroup();
    for (int i = 0; i < all.numDisplays(); ++i) {
      if (all.getDisplayAt(i)->getNameStd() == name) {
        return all.getDisplayAt(i);
      }
    }
    return nullptr;
  }
  void remove(rviz::Display& display) {
    display.setEnabled(false);
    delete &display;
  }

  /// Lets rviz work until something is true, a minute at most.
  static bool wait_until(const std::function<bool()>& is_true) {
    QElapsedTimer timer;
    timer.start();
    while (!is_true()) {
      if (timer.elapsed() > 60000) {
        return false;
      }
      ros::spinOnce();
      QApplication::processEvents(QEventLoop::AllEvents, 10);
    }
    return true;
  }

  /// Lets rviz do what it has begun: messages are drawn in its next update, statuses come after.
  void settle() {
    const std::uint64_t begin = manager_->getFrameCount();
    wait_until([&] { return manager_->getFrameCount() > begin + 2; });
  }

  /// The status of the display with this name.
  static Status status(const rviz::Display& display, const std::string& name) {
    for (int i = 0; i < display.numChildren(); ++i) {
      const auto* list = dynamic_cast<const rviz::StatusList*>(display.childAt(i));
      for (int k = 0; list != nullptr && k < list->numChildren(); ++k) {
        const rviz::Property* entry = list->childAt(k);
        if (entry->getNameStd() == name) {
          return {static_cast<const rviz::StatusProperty*>(entry)->getLevel(),
                  entry->getValue().toString().toStdString()};
        }
      }
    }
    return {};
  }

  /// Draws, whether or not there is anything new.
  void draw() { panel_->getRenderWindow()->update(); }

  /// The picture that is to be seen now.
  /// @param border part of the width and height that is left out at each side
  std::vector<Pixel> picture(double border = 0.0) {
    draw();
    const QImage image = QGuiApplication::primaryScreen()->grabWindow(panel_->winId()).toImage();
    const auto left = static_cast<int>(border * image.width());
    const auto top = static_cast<int>(border * image.height());
    std::vector<Pixel> pixels;
    for (int y = top; y < image.height() - top; ++y) {
      for (int x = left; x < image.width() - left; ++x) {
        const QRgb pixel = image.pixel(x, y);
        pixels.push_back({static_cast<std::uint8_t>(qRed(pixel)),
                          static_cast<std::uint8_t>(qGreen(pixel)),
                          static_cast<std::uint8_t>(qBlue(pixel))});
      }
    }
    return pixels;
  }

  std::size_t count_pixels(const std::function<bool(const Pixel&)>& is_counted,
                           double border = 0.0) {
    std::size_t count = 0;
    for (const Pixel& pixel : picture(border)) {
      count += is_counted(pixel) ? 1 : 0;
    }
    return count;
  }

  /// Pixels that are not rviz's background of dark grey.
  std::size_t count_drawn() {
    return count_pixels([](const Pixel& pixel) { return pixel != Pixel{48, 48, 48}; });
  }

 private:
  std::unique_ptr<rviz::RenderPanel> panel_;
  std::unique_ptr<rviz::VisualizationManager> manager_;
};

}  // namespace rviz_test
