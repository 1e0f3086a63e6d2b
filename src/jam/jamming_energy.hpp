#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "bernal/core/spheres.hpp"
#include "core/archive.hpp"
#include "core/made.hpp"
#include "jam/near_walls.hpp"
#include "jam/trust_region.hpp"
#include "near/periodic_pairs.hpp"

namespace bernal {

/// What a JammingEnergy, which see, is in any dimension.
class JammingFunction : public SmoothFunction {
 public:
  static constexpr std::uint32_t wall = 0xffffffff;
  /// Of a contact of two spheres, or of one with `wall`, force over distance.
  struct Tension {
    std::uint32_t first, second;
    double tension;
  };

  virtual std::unique_ptr<JammingFunction> copy() const = 0;
  virtual int dimension() const = 0;

  /// Sets the load so that spheres with 2 D contacts each have roughly the mean overlap ratio `overlap`; the
  /// smoothing is a ratio too. Evaluates.
  virtual void set_level(double overlap, double smoothing) = 0;

  /// The length, in the metric of the preconditioner, of a motion of all spheres by `ratio` of their
  /// diameters.
  double length_of(double ratio) const { return ratio * std::sqrt(load_per_overlap_); }

  /// Until `release`, only the present overlaps of spheres i with bears[i] count, as springs that pull as
  /// well as push, so that the equations of equilibrium are smooth. Precondition: smoothing 0.
  virtual void hold(const std::vector<char>& bears) = 0;
  /// Drops a held contact.
  virtual void let_go(std::size_t contact) = 0;
  /// Until `release`, spheres i with fixed[i], and the box, do not move, and fixed spheres do not meet each
  /// other. Call set_level afterwards.
  void fix(std::vector<char> fixed) { fixed_ = std::move(fixed); }
  /// Contacts may form and break again, and all spheres move. Call set_level afterwards.
  void release() {
    held_ = false;
    fixed_.clear();
  }

  std::size_t size() const { return radius_.size(); }
  double radius(std::size_t i) const { return radius_[i]; }
  /// Size of the box and its walls relative to the initial one.
  virtual double scale() const = 0;
  virtual std::size_t contact_count() const = 0;
  virtual Tension tension_of(std::size_t contact) const = 0;
  /// Energy of all springs without the part of smoothing: a scale for changes of H. Positive if anything
  /// touches.
  virtual double elastic_energy() const = 0;
  /// The largest o / s; 0 if nothing overlaps.
  virtual double largest_overlap() const = 0;

  /// Its state except for the last move and the preconditioner, for an object made with the same number of
  /// spheres and the same walls.
  virtual void archive(Archive& a) = 0;

 protected:
  std::vector<double> radius_;
  double load_per_overlap_ = 0;
  bool held_ = false;
  std::vector<char> fixed_;  // empty if none is
};

/// Soft spheres in a periodic box, or between walls, under pressure: a function of all centres and of the
/// size of the box, walls included, whose minimum tends to a jammed packing of hard spheres as the pressure
/// goes to zero.
///
/// Spheres with centres d apart and radii that sum to s overlap by o = s - d. They repel each other with the
/// force f = k x, where x >= max(0, o) is the smoothed overlap
///   x (x - o) = (t s)²,   that is   x = (o + sqrt(o² + 4 t² s²)) / 2:
/// a spring if they overlap by more than t s, a hard wall's force (proportional to 1 / gap) if they do not
/// touch; cut off at a gap of 30 t s (or s/10). With smoothing t = 0 it is the plain spring x = max(0, o).
/// The stiffness is k = s^(D - 2), as for a material with one modulus for small and large spheres: in
/// equilibrium all overlap ratios o / s are of one order, however much the sizes differ.
///
/// The box may dilate by a factor 1 + e, with all centres, against the load p = D · pressure · volume:
///   H(u, e) = sum over pairs of the work of f + p ln(1 + e),   r -> (1 + e)(r + u).
/// In equilibrium p is the sum of f d over all contacts. A motion v has D N + 1 components, u of each sphere
/// and then e. The second variation of H is the sum over contacts of
///   f'(o) (n·w + e d)² - (f / d) |w - n (n·w)|²,   w = ui - uj,
/// minus p e² and minus a term that vanishes in equilibrium.
///
/// A wall is a mirror: the contact with it is half of that with the sphere's image, s = r and o = r - d for
/// the distance d of the centre, k = 2 (2 r)^(D - 2). Walls dilate with the box, w = ui, and |w - n (n·w)|²
/// is replaced by w·Bw, with B d times the second derivative of d (`bend_of`).
///
/// Sources: O'Hern, Silbert, Liu & Nagel, Phys. Rev. E 68, 011306 (2003), the potential and the way to
/// jamming; Dagois-Bohy, Tighe, Simon, Henkes & van Hecke, Phys. Rev. Lett. 109, 095703 (2012), the box as an
/// unknown; Chen & Mangasarian, Comput. Optim. Appl. 5, 97 (1996), the smoothing.
template <int D>
class JammingEnergy final : public JammingFunction {
 public:
  struct Contact {
    using ArchivedAsBytes = void;
    Vector<D> normal;  // from the second to the first
    double stiffness;  // f'(o)
    double tension;    // f / d
    double distance;   // d
    std::uint32_t first, second;
    bool is_pair() const { return second != wall; }
  };

  /// Precondition: at least one sphere. Centres may be anywhere; with walls inside these, and `edges` so
  /// large along such axes that no sphere meets an image.
  JammingEnergy(const Spheres<D>& spheres, const Vector<D>& edges,
                std::shared_ptr<const Enclosure<D>> enclosure = nullptr);

  std::unique_ptr<JammingFunction> copy() const override { return std::make_unique<JammingEnergy>(*this); }
  int dimension() const override { return D; }
  void set_level(double overlap, double smoothing) override;
  void hold(const std::vector<char>& bears) override;
  void let_go(std::size_t contact) override;

  Eigen::Index unknowns() const override { return static_cast<Eigen::Index>(D * size() + 1); }
  const Vector<D>& edges() const { return state_.edges; }
  double scale() const override { return state_.scale; }
  /// Those of pairs come first.
  const std::vector<Contact>& contacts() const { return now_.contacts; }
  std::size_t contact_count() const override { return now_.contacts.size(); }
  Tension tension_of(std::size_t contact) const override {
    const Contact& c = now_.contacts[contact];
    return {c.first, c.second, c.tension};
  }
  const Eigen::VectorXd& gradient() const override { return now_.gradient; }
  double elastic_energy() const override { return now_.elastic; }
  double largest_overlap() const override { return now_.largest_overlap; }

  /// out = Hessian · v.
  void hessian_times(const Eigen::VectorXd& v, Eigen::VectorXd& out) const override;
  /// Computes a block Jacobi preconditioner for the present state, a D x D block for each sphere: positive
  /// definite. It is also the metric of lengths of motions: every motion has a positive length, even that of
  /// a sphere without contacts.
  void factor_preconditioner() override;
  void precondition(const Eigen::VectorXd& v, Eigen::VectorXd& out) const override;

  /// Moves all and dilates the box. Returns the change of H; infinite if the box shrinks to less than half,
  /// or with walls if a sphere moves so far that it might get through one.
  double move(const Eigen::VectorXd& motion) override;
  /// Undoes the last move. Precondition: there was one since the last set_level that was not undone.
  void take_back() override;

  /// Sets the centres, wrapped into the box.
  void write(Spheres<D>& spheres) const;
  /// Sets the centres unwrapped, relative to the box's initial size (scale 1).
  void write_to_scale(Spheres<D>& spheres) const;

  void archive(Archive& a) override;

 private:
  struct State {
    Eigen::VectorXd centers;
    Vector<D> edges;
    double scale = 1;
    void archive(Archive& a) { a(centers, edges, scale); }
  };
  using Block = Eigen::Matrix<double, D, D>;
  struct Evaluation {
    std::vector<Contact> contacts;
    std::vector<Block> bends;  // of contacts with walls
    Eigen::VectorXd gradient;
    double energy = 0, elastic = 0, largest_overlap = 0;
    void archive(Archive& a) { a(contacts, bends, gradient, energy, elastic, largest_overlap); }
  };
  struct Spring {
    double force, stiffness;
  };

  bool pairs_are_complete() const;
  void find_pairs();
  void find_walls();
  void hold_walls(const std::vector<char>& bears);
  void evaluate();
  void meet(std::uint32_t first, std::uint32_t second, const Vector<D>& away);
  void meet_walls();
  void meet_wall(std::uint32_t i, const Vector<D>& p, const NearPiece<D>& near, std::size_t first);
  Spring press(double s, double overlap, double stiffness);
  bool is_fixed(std::uint32_t i) const { return !fixed_.empty() && fixed_[i]; }
  void still(Eigen::VectorXd& v) const;
  bool moves_too_far(const Eigen::VectorXd& motion) const;
  Vector<D> away_of(const typename PeriodicPairs<D>::Pair& pair) const;
  double width() const;

  Made made_{"polish"};
  std::vector<std::uint32_t> order_;  // index of a sphere here -> its number outside
  double least_radius_ = 0, largest_radius_ = 0;
  double load_ = 0, smoothing_ = 0;

  State state_, state_before_;
  Evaluation now_, before_;

  PeriodicPairs<D> pairs_;
  std::shared_ptr<const Enclosure<D>> enclosure_;
  std::shared_ptr<const NearWalls<D>> near_walls_;  // null without walls
  State at_finding_;
  double width_at_finding_ = 0;

  std::vector<Block> inverse_blocks_;
  double inverse_dilation_ = 0;
};

}  // namespace bernal
