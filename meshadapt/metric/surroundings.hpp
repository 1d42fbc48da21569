/// @file
/// Surroundings<Dim>: the vertices around a vertex, layer by layer, and their shape: a linear map
/// after which they lie about equally far away in all directions. Fits are made in that shape, so a
/// mesh that is stretched a thousand times is as good as another.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// Lower triangular factor L of the mean of d d' over displacements d; d seen from there is L^-1 d.
template <int Dim>
class Shape {
 public:
  void add(const Vector<Dim>& d) {
    ++count_;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j <= i; ++j) at(i, j) += d[i] * d[j];
  }

  /// To be called once, after the last add. A direction without extent keeps a tiny one.
  void factorise() {
    constexpr double least = 1e-14;
    double largest = 0;
    for (int i = 0; i < Dim; ++i) largest = std::max(largest, at(i, i) /= count_);
    for (int j = 0; j < Dim; ++j) {
      for (int k = 0; k < j; ++k) at(j, j) -= at(j, k) * at(j, k);
      at(j, j) = std::sqrt(std::max(at(j, j), least * least * largest));
      for (int i = j + 1; i < Dim; ++i) {
        at(i, j) /= count_;
        for (int k = 0; k < j; ++k) at(i, j) -= at(i, k) * at(j, k);
        at(i, j) /= at(j, j);
      }
    }
  }

  /// L^-1 d, for displacements.
  Vector<Dim> seen(Vector<Dim> d) const {
    for (int i = 0; i < Dim; ++i) {
      for (int k = 0; k < i; ++k) d[i] -= at(i, k) * d[k];
      d[i] /= at(i, i);
    }
    return d;
  }

  /// L^-T g, for gradients: from derivatives there to derivatives here.
  Vector<Dim> unseen(Vector<Dim> g) const {
    for (int i = Dim; i-- > 0;) {
      for (int k = i + 1; k < Dim; ++k) g[i] -= at(k, i) * g[k];
      g[i] /= at(i, i);
    }
    return g;
  }

 private:
  double& at(int i, int j) {
    return l_[static_cast<std::size_t>(i)].x[static_cast<std::size_t>(j)];
  }
  double at(int i, int j) const { return l_[static_cast<std::size_t>(i)][j]; }

  std::array<Vector<Dim>, Dim> l_{};
  double count_ = 0;
};

/// A buffer to use for one vertex after another.
template <int Dim>
class Surroundings {
 public:
  /// Starts with the vertices of the elements around `centre`, without itself.
  void start(const auto& mesh, VertexId centre) {
    centre_ = centre;
    vertices_.assign(1, centre);
    grow(mesh);
  }

  /// Adds those of one layer of elements more. False if there are none.
  bool grow(const auto& mesh) {
    next_ = vertices_;
    next_.push_back(centre_);
    for (const VertexId v : vertices_)
      for (const ElementId element : mesh.elements_of(v))
        next_.insert(next_.end(), mesh.corners_of[element].begin(), mesh.corners_of[element].end());
    std::sort(next_.begin(), next_.end());
    next_.erase(std::unique(next_.begin(), next_.end()), next_.end());
    std::erase(next_, centre_);
    std::swap(vertices_, next_);
    return vertices_.size() > next_.size();
  }

  VertexId centre() const { return centre_; }
  /// In ascending order.
  const std::vector<VertexId>& vertices() const { return vertices_; }

 private:
  VertexId centre_ = none;
  std::vector<VertexId> vertices_, next_;
};

}  // namespace ductile::meshadapt
