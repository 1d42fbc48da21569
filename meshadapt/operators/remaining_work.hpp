/// @file
/// RemainingWork: about how much of a mesh the end of a run would change. A mesh of which that is
/// little has been adapted to its metric before and shall stay as it is. Only what can be done
/// counts: edges that the rules let nobody change are there after a run as they were before, and so
/// are poor elements that no move or swap makes better.
#pragma once

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"
#include "operators/background.hpp"
#include "operators/edge_survey.hpp"
#include "operators/smooth.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space = Dim>
class RemainingWork {
 public:
  static constexpr double poor = 0.3;  ///< mean ratio of elements that are moved for their sake

  /// The settings that decide when a run ends.
  struct Settings {
    Rules rules;
    SmoothOptions smooth;
    double swap_below;  ///< mean ratio of elements that are swapped
    bool swaps, moves;  ///< are there any?
    std::size_t few;    ///< changes of lengths; there is no need to know of more
  };

  /// Thread safety: one caller; runs on the executor, as all of its functions do.
  RemainingWork(const runtime::Executor& executor, Mesh<Dim, Space>& mesh,
                const Background<Dim, Space>& background, const Settings& settings)
      : executor_(executor), mesh_(mesh), background_(background), settings_(settings) {}

  /// Collapses, splits, swaps and moves of poor elements; nothing but collapses and splits if these
  /// are not few, and then not all of them. The survey is one of all edges out of the range.
  std::size_t count(EdgeSurvey<Dim, Space>& survey);

  /// Marks the poor elements found as changed, so that the kernels look at them.
  void touch_poor();

 private:
  std::size_t changes_of_lengths(EdgeSurvey<Dim, Space>& survey) const;
  bool is_raised(const Smooth<Dim, Space>& smoothing, VertexId vertex) const;
  runtime::UnsetVector<VertexId> raised() const;

  const runtime::Executor& executor_;
  Mesh<Dim, Space>& mesh_;
  const Background<Dim, Space>& background_;
  Settings settings_;
  runtime::UnsetVector<VertexId> raised_;
};

}  // namespace ductile::meshadapt
