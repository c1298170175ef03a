#ifndef impm_balance_terms_contact_h
#define impm_balance_terms_contact_h

#include <impm/balance/free_bodies.h>
#include <impm/balance/terms/term.h>
#include <impm/contact/contact_links.h>

namespace impm
{
  /** What a pair of bodies does where their surfaces touch, or are bonded: sums
   * of pressure, as far as it acts, and of friction, each without regard to its
   * direction (N), the area (m^2), and the largest pressure (Pa). */
  struct ContactFigures
  {
    double normal_force = 0, friction_force = 0, area = 0, largest_pressure = 0;
  };

  /**
   * Contact and bonds between surfaces. The outermost layer of a body, as thick
   * as d, a small part of a cell, is as stiff as its material is for
   * longitudinal waves, with the modulus M of the softer side. By its energy
   * per area,
   *
   *   psi = M d / 2 max(0, -g / d)^2,
   *
   * it presses where the gap g between surfaces is closed, and is not pressed
   * through by any pressure less than M. A bond resists likewise in all
   * directions, and pulls as well.
   *
   * Coulomb's friction resists slip like a layer of a third of that stiffness,
   * up to the coefficient times the pressure. In a step it derives from an
   * energy, too, since that bound is fixed while the step is solved:
   * renew() takes it from the pressures that came out, until they
   * agree. What is beyond the bound is dissipated. The tangent of what slips
   * is nothing along the slip, for one side of a kink: where Newton's method
   * takes it for the other, it would not settle. So the force there is taken
   * for an unknown as well, as the method for total variation does (Chan,
   * Golub & Mulet, SIAM J. Sci. Comput. 20, 1999): while the force of the last
   * tangent, carried on by that, is not yet what the slip makes it, the tangent
   * is stiffer; in the end it is exact.
   *
   * Over a step, time integrators take a mean of the forces at both ends. Where
   * bodies part within it, so that nothing of a pair touches at its end, that
   * at the start acts for the part of the way on which surfaces do: all the way
   * it would do more work than the layer has stored. By the trapezoidal rule
   * that at the end does so, too, where they meet, and impacts keep energy
   * however long steps are; others damp there.
   *
   * Normals of obstacles are those where points come to; of other bodies, those
   * at the start of the step. Friction acts along the surface at the start, on
   * an obstacle that turns where the last solution has brought the point: that
   * is renewed with its bound.
   */
  template <int dim>
  class Contact : public Term
  {
  public:
    /** With the free bodies of the scene, or null, and the weight of the forces
     * at the end of the step. Collective. */
    Contact(ContactLinks<dim> links,
            FreeBodies<dim>  *free,
            double            weight,
            MPI_Comm          comm);

    bool
    evaluate(const Vector &u, bool with_tangent) override;

    void
    add_force(const Vector &u, Vector &force) const override;

    void
    add_end_force(const Vector &u, Vector &force) const override;

    void
    add_start_force(Vector &force) const override;

    double
    energy(const Vector &u, const Vector &felt) const override;

    std::vector<double>
    squares_of_parts(const Vector &u, const ResidualNorm &norm) const override;

    void
    apply(const Vector &direction, Vector &image) const override;

    void
    add_matrix(bool only_pattern, const TakeBlock &take) const override;

    void
    take_tangent() override;

    void
    project_tangent() override;

    /** What free bodies give way by. Collective. */
    void
    add_correction(const Vector &like, LowRank &correction) const override;

    /** Takes from the state what is fixed while the step is solved: bounds of
     * friction, on what turns its directions, and which bodies part. Returns
     * whether so much has changed that the step is to be solved anew.
     * Collective. */
    bool
    renew();

    /** Sum of what presses, without regard to direction (N), in the state.
     * Collective. */
    double
    total_force() const;

    /** What the layers store and friction has taken in the step (J), of this
     * rank. */
    double
    energy_gain() const;

    /** Force (N) on what a pair of the scene has for a partner, in the state,
     * of this rank. */
    dealii::Tensor<1, dim>
    force_on_partner(unsigned int pair) const;

    /** Its moment about a point (N m), at the places of the state. */
    RotationVector
    moment_on_partner(unsigned int pair, const dealii::Point<dim> &about) const;

    /** Of a pair of the scene, in the state. Collective. */
    ContactFigures
    figures(unsigned int pair, MPI_Comm communicator) const;

    /** The work (J) of obstacles, but free bodies, on the others in the step,
     * taking forces for the mean of those at both ends. Of this rank. */
    double
    work_of_obstacles() const;

    /** Lets the points of the surfaces know what they have met. */
    void
    remember_meetings(SurfacePoints<dim> &points) const;

    /** Smallest gap over its layer, of this rank: below 0 where surfaces touch,
     * -1 where a layer is pressed through. */
    double
    smallest_gap() const;

    /** (bytes) */
    std::size_t
    memory_consumption() const
    {
      return bytes_of(
        all.links, all.nodes, all.coefficients, states, bounds, at_tangent);
    }

    const ContactLinks<dim> all;

  private:
    /** Of friction: what resists a slip, in the frame of the obstacle. */
    struct Friction
    {
      dealii::Tensor<1, dim>          slip;    ///< (m)
      dealii::Tensor<1, dim>          force;   ///< per area (Pa)
      dealii::SymmetricTensor<2, dim> tangent; ///< (Pa/m)
    };

    /** Of a link, at an increment. Directions are those of space. */
    struct State
    {
      dealii::Point<dim>     place;   ///< (m)
      dealii::Tensor<1, dim> carried; ///< way of the obstacle there (m)
      /** Per area (J/m^2): what layers store and friction takes, and of what
       * the gradient is the derivative. */
      double energy = 0, potential = 0;
      /** On the partner (Pa): what the balance is given for the end of the
       * step, and what is there. */
      dealii::Tensor<1, dim> gradient, end_gradient;
      /** Derivative of the gradient but for the curvature of obstacles, and
       * what that adds (Pa/m). */
      dealii::SymmetricTensor<2, dim> tangent, curved;
      double                          pressure = 0; ///< at the end (Pa)
      double                          given    = 0; ///< to the balance (Pa)
      double                          friction = 0; ///< along it (Pa)
      double                          gap      = 0; ///< (m)
      /** Of the layer, before what is beyond the bound has slipped (m). */
      dealii::Tensor<1, dim> slip;
      Friction               shear;
    };

    /** Of a link, at a slip. */
    Friction
    friction_at(unsigned int link, const dealii::Tensor<1, dim> &slip) const;

    /** After a way along the other surface, as seen from there. */
    State
    state_at(unsigned int link, const dealii::Tensor<1, dim> &way) const;

    /** After an increment of the point, or of what is faced less than that. */
    State
    state_after(unsigned int                  link,
                const dealii::Tensor<1, dim> &increment) const;

    /** Which pairs press somewhere. Collective. */
    std::vector<bool>
    touches(const std::vector<State> &some) const;

    /** What contact does on the free bodies as they are. Collective. */
    std::vector<typename FreeBodies<dim>::Load>
    loads_on_free_bodies() const;

    /** The states for increments of links, with the free bodies where they
     * are settled; false if they do not settle. Collective. */
    bool
    settle(const std::vector<dealii::Tensor<1, dim>> &increments);

    /** Of what is exerted at a link, by a further motion of its free body. */
    dealii::Tensor<1, dim>
    change_by(unsigned int link, unsigned int component) const;

    /** Adds a gradient at the nodes of a link. */
    void
    add(unsigned int                  link,
        const dealii::Tensor<1, dim> &gradient,
        Vector                       &force) const;

    /** sum_k c_k u_k (m). */
    dealii::Tensor<1, dim>
    increment_of(const ContactLink<dim> &link, const Vector &u) const;

    /** Of friction, over that of the layer. */
    static constexpr double friction_stiffness = 1. / 3;

    const double       weight; ///< of forces at the end of the step
    std::vector<State> states;
    std::vector<State> starts; ///< of the step
    /** Where a tangent was taken, if any was. */
    std::vector<Friction> at_tangent;
    /** Of friction (Pa); below zero, so much of that at the start is let go. */
    std::vector<double> bounds;
    /** Of a pair: whether its bodies meet in the step, or part. */
    std::vector<bool> is_passing;
    /** Across which it acts, as an obstacle is at the start of the step. */
    std::vector<dealii::Tensor<1, dim>> normals;
    std::vector<RigidMotion<dim>>       motions; ///< of obstacles, by pair
    FreeBodies<dim> *const              free;
    const MPI_Comm                      communicator;
  };
} // namespace impm

#endif
