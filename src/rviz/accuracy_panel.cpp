#include "src/rviz/accuracy_panel.hpp"

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/names.h>
#include <ros/service.h>

#include <QFormLayout>
#include <QVBoxLayout>
#include <pluginlib/class_list_macros.hpp>

namespace fiber_proximity_rviz {
namespace {

constexpr int refresh_ms = 100;
constexpr double measuring_time = 10.0;  // [s]

double now() { return ros::WallTime::now().toSec(); }

/// @returns an error, or nothing
std::string set_parameters(const std::string& service, const dynamic_reconfigure::Config& config) {
  dynamic_reconfigure::Reconfigure request;
  request.request.config = config;
  return ros::service::call(service, request) ? "" : service + " does not answer";
}

/// @returns with a message where the node has not measured
fiber_proximity::MeasureSettings::Response measure_settings(const std::string& service) {
  fiber_proximity::MeasureSettings call;
  call.request.seconds = measuring_time;
  if (!ros::service::call(service, call)) {
    call.response.message = service + " does not answer";
  }
  return call.response;
}

}  // namespace

AccuracyPanel::AccuracyPanel(QWidget* parent)
    : rviz::Panel(parent),
      name_(new QLineEdit(QString::fromStdString(node_), this)),
      form_(new ParameterForm(
          {"kernel", "query_type", "accuracy", "margin", "tolerance", "deadline", "continuous",
           "prediction"},
          [this](const dynamic_reconfigure::Config& config, const std::string& text) {
            change(config, text);
          },
          this)),
      answer_(new QLabel(this)),
      status_(new QLabel(this)),
      plot_(new AnswerPlot(history_, this)),
      tabs_(new QTabWidget(this)),
      measure_button_(new QPushButton("measure here", this)),
      timer_(new QTimer(this)) {
  name_->setObjectName("node");
  answer_->setObjectName("answer");
  status_->setObjectName("status");
  plot_->setObjectName("plot");
  measure_button_->setObjectName("measure");
  measure_button_->setToolTip("Every setting for some seconds, beside the node's other work");
  answer_->setWordWrap(true);
  status_->setWordWrap(true);
  auto* layout = new QVBoxLayout(this);
  auto* top = new QFormLayout();
  top->addRow("node", name_);
  layout->addLayout(top);
  layout->addWidget(form_);
  layout->addWidget(answer_);
  tabs_->addTab(plot_, "live");
  layout->addWidget(tabs_, 1);
  layout->addWidget(measure_button_);
  layout->addWidget(status_);
  QObject::connect(name_, &QLineEdit::editingFinished, this, [this] {
    const std::string asked = name_->text().toStdString();
    if (asked != node_) {
      node_ = asked;
      subscribe();
      Q_EMIT configChanged();
    }
  });
  QObject::connect(measure_button_, &QPushButton::clicked, this, [this] { measure(); });
  QObject::connect(timer_, &QTimer::timeout, this, [this] { update_plot(); });
  timer_->start(refresh_ms);
  subscribe();
}

AccuracyPanel::~AccuracyPanel() = default;

void AccuracyPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString node;
  if (config.mapGetString("Node", &node) && node.toStdString() != node_) {
    node_ = node.toStdString();
    name_->setText(node);
    subscribe();
  }
}

void AccuracyPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Node", QString::fromStdString(node_));
}

void AccuracyPanel::subscribe() {
  for (ros::Subscriber* subscriber : {&answers_, &descriptions_, &values_, &log_}) {
    subscriber->shutdown();
  }
  history_.clear();
  form_->describe({});
  std::string error;
  if (!ros::names::validate(node_, error)) {
    say("'" + node_ + "' is no node's name: " + error, true);
    return;
  }
  constexpr std::uint32_t queue = 100;
  answers_ = handle_.subscribe(node_ + "/statistics", queue, &AccuracyPanel::process, this);
  descriptions_ = handle_.subscribe<dynamic_reconfigure::ConfigDescription>(
      node_ + "/parameter_descriptions", 1,
      [this](const dynamic_reconfigure::ConfigDescriptionConstPtr& description) {
        form_->describe(*description);
        form_->show_values(current_);
        say("", false);
      });
  values_ = handle_.subscribe<dynamic_reconfigure::Config>(
      node_ + "/parameter_updates", 1, [this](const dynamic_reconfigure::ConfigConstPtr& values) {
        for (const std::string& changed : changed_values(current_, *values)) {
          history_.mark(now(), changed);
        }
        current_ = *values;
        form_->show_values(current_);
      });
  log_ = handle_.subscribe("/rosout", queue, &AccuracyPanel::process_log, this);
  say("waiting for node " + node_, false);
}

void AccuracyPanel::process(const fiber_proximity::StatisticsConstPtr& answer) {
  history_.add(now(), *answer);
  answer_->setText(QString::fromStdString(answer->summary));
}

/// Messages of the node about its settings are shown in its own words.
void AccuracyPanel::process_log(const rosgraph_msgs::LogConstPtr& log) {
  const bool is_of_node = ros::names::resolve(log->name) == ros::names::resolve(node_);
  if (is_of_node && log->level >= rosgraph_msgs::Log::WARN) {
    say(log->msg, true);
  }
}

void AccuracyPanel::change(const dynamic_reconfigure::Config& config, const std::string& text) {
  if (config.doubles.empty() && config.strs.empty() && config.bools.empty()) {
    say(text + " is not a number", true);
    form_->show_values(current_);
    return;
  }
  if (pending_) {
    pending_->wait();
    show_change();
  }
  say("", false);
  pending_ = std::async(std::launch::async, set_parameters, node_ + "/set_parameters", config);
}

void AccuracyPanel::show_change() {
  const std::string error = pending_->get();
  pending_.reset();
  if (!error.empty()) {
    say(error, true);
  }
  form_->show_values(current_);
}

void AccuracyPanel::measure() {
  if (measuring_) {
    return;
  }
  measure_button_->setEnabled(false);
  measure_button_->setText("measuring ...");
  measuring_ = std::async(std::launch::async, measure_settings, node_ + "/measure_settings");
}

void AccuracyPanel::show_measurement() {
  const fiber_proximity::MeasureSettings::Response measured = measuring_->get();
  measuring_.reset();
  measure_button_->setEnabled(true);
  measure_button_->setText("measure here");
  if (measured.success != 0) {
    while (tabs_->count() > 1) {
      delete tabs_->widget(1);
    }
    for (const std::string& question : measured.questions) {
      auto* chart = new SettingsChart(question, measured, tabs_);
      chart->setObjectName(QString::fromStdString("chart of " + question));
      tabs_->addTab(chart, QString::fromStdString(question));
    }
    tabs_->setCurrentIndex(1);
    say("", false);
  } else {
    say(measured.message, true);
  }
}

void AccuracyPanel::say(const std::string& text, bool is_error) {
  status_->setStyleSheet(is_error ? "color: #b00000" : "");
  status_->setText(QString::fromStdString(text));
}

void AccuracyPanel::update_plot() {
  if (pending_ && pending_->wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    show_change();
  }
  if (measuring_ && measuring_->wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    show_measurement();
  }
  history_.forget(now());
  plot_->show_at(now());
}

}  // namespace fiber_proximity_rviz

PLUGINLIB_EXPORT_CLASS(fiber_proximity_rviz::AccuracyPanel, rviz::Panel)
