#ifndef impm_materials_hardening_bilinear_h
#define impm_materials_hardening_bilinear_h

#include <deal.II/base/parameter_handler.h>

#include <impm/input/parameter_file.h>

#include <array>

namespace impm
{
  /**
   * A yield stress that is piecewise linear in the equivalent plastic strain
   * (Sulsky & Kaul 2004, eq. 2.1.19): it grows up to a limit strain, falls
   * behind it, and stays where it reaches zero.
   */
  class BilinearHardening
  {
  public:
    /**
     * Yield stress (Pa), its slope (Pa); behind the limit strain (0: none) it
     * falls with the softening modulus (Pa, >= 0).
     */
    BilinearHardening(double yield_stress,
                      double modulus,
                      double limit_strain = 0,
                      double softening    = 0);

    static void
    declare_parameters(dealii::ParameterHandler &prm);

    /** The entry that depends on the limit strain. */
    static void
    declare_chosen(dealii::ParameterHandler    &prm,
                   const ParameterFile::Chosen &chosen);

    static BilinearHardening
    from_parameters(dealii::ParameterHandler &prm);

    /** Yield stress (Pa). */
    double
    yield_stress(double plastic_strain) const;

    /** Its integral since the start: plastic work (J/m^3). */
    double
    work(double plastic_strain) const;

    struct Flow
    {
      double plastic_strain; ///< at the end
      double slope;          ///< of the yield stress there (Pa)
    };

    /**
     * Where the von Mises stress `trial` falls on the yield stress when it
     * goes down by `resistance` (3 G) times the flow: backward Euler. The
     * trial stress is above the yield stress.
     */
    Flow
    flow(double trial, double plastic_strain, double resistance) const;

    const double steepest_fall; ///< Pa, 0 if it does not soften

  private:
    struct Segment
    {
      double begin;        ///< plastic strain
      double yield_stress; ///< there
      double slope;
      double work; ///< up to there
    };

    const Segment &
    segment(double plastic_strain) const;

    std::array<Segment, 3> segments;
    unsigned int           n_segments = 1;
  };
} // namespace impm

#endif
