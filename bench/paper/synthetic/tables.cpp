#include "tables.hpp"

#include <array>
#include <cmath>

#include "shared/table.hpp"

namespace ductile::paper {

namespace {

/// Seconds per step: the kernels, the rest, the metric, and all but the metric.
std::vector<double> seconds_per_step(const TimedSteps& timed) {
  const KernelSeconds& sum = timed.seconds;
  std::vector<double> seconds(sum.kernels.begin(), sum.kernels.end());
  for (const double other : {sum.other, sum.metric, sum.adapt()}) seconds.push_back(other);
  for (double& value : seconds) value /= timed.steps;
  return seconds;
}

std::vector<std::string> columns(const std::string& first) {
  std::vector<std::string> names{first};
  for (const meshadapt::NamedKernel& kernel : meshadapt::kernels) names.emplace_back(kernel.name);
  for (const char* other : {"other", "metric", "adapt"}) names.emplace_back(other);
  return names;
}

double rate_between(const ErrorRow& coarse, const ErrorRow& fine,
                    double InterpolationError::*norm) {
  return std::log(coarse.error.*norm / (fine.error.*norm)) /
         std::log(fine.elements / coarse.elements);
}

}  // namespace

void say_kernels(Experiment& experiment, const std::string& name, const MarchReport& report) {
  Table seconds(columns("threads")), efficiency(columns("threads")), all(columns("threads"));
  const auto row = [](int threads, std::vector<double> values) {
    values.insert(values.begin(), threads);
    return values;
  };
  const TimedSteps& fewest = report.timed.front();
  const std::vector<double> alone = seconds_per_step(fewest);
  for (const TimedSteps& timed : report.timed) {
    const std::vector<double> taken = seconds_per_step(timed);
    std::vector<double> share = taken;
    for (std::size_t k = 0; k < share.size(); ++k)
      share[k] = alone[k] * fewest.threads / (taken[k] * timed.threads);
    seconds.add(row(timed.threads, taken));
    efficiency.add(row(timed.threads, share));
  }
  all.add(row(report.all.threads, seconds_per_step(report.all)));
  seconds.write_csv(experiment.file("seconds_" + name + ".csv"));
  efficiency.write_csv(experiment.file("efficiency_" + name + ".csv"));
  experiment.say("\n%s, %.0f elements on average; seconds per step, mean of all %d steps:\n%s",
                 name.c_str(), report.mean_elements, report.all.steps, all.text().c_str());
  experiment.say("mean of the %d steps taken on each number of threads:\n%s", fewest.steps,
                 seconds.text().c_str());
  experiment.say("parallel efficiency:\n%s", efficiency.text().c_str());
}

void say_errors(Experiment& experiment, const std::string& name,
                const std::vector<ErrorRow>& rows) {
  Table table({"elements", "L2_beside_jump", "rate", "L1_everywhere", "rate"});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const InterpolationError& error = rows[i].error;
    const ErrorRow& before = rows[i == 0 ? 0 : i - 1];
    const auto rate = [&](double InterpolationError::*norm) {
      return i == 0 ? 0.0 : rate_between(before, rows[i], norm);
    };
    table.add({rows[i].elements, error.beside_jump, rate(&InterpolationError::beside_jump),
               error.everywhere, rate(&InterpolationError::everywhere)});
  }
  table.write_csv(experiment.file("errors_" + name + ".csv"));
  experiment.say("\n%s, interpolation error, and rates r of error ~ elements^-r:\n%s", name.c_str(),
                 table.text().c_str());
}

double convergence_rate(const std::vector<ErrorRow>& rows) {
  return rate_between(rows.front(), rows.back(), &InterpolationError::beside_jump);
}

}  // namespace ductile::paper
