#ifndef impm_materials_hardening_list_h
#define impm_materials_hardening_list_h

#include <impm/materials/hardening/bilinear.h>
#include <impm/materials/hardening/curve_hardening.h>
#include <impm/materials/hardening/johnson_cook.h>
#include <impm/materials/hardening/linear.h>
#include <impm/materials/hardening/ludwik.h>
#include <impm/materials/hardening/swift.h>
#include <impm/materials/hardening/table.h>
#include <impm/materials/hardening/voce.h>

namespace impm
{
  template <typename T>
  struct TypeOf
  {
    using type = T;
  };

  template <typename... Types>
  struct TypeList
  {
    /** Calls action(TypeOf<Type>()) for each. */
    template <typename Action>
    static void
    for_each(const Action &action)
    {
      (action(TypeOf<Types>()), ...);
    }
  };

  /**
   * Every hardening that a law with a yield stress can have, the default first;
   * a new one is added here.
   */
  using Hardenings = TypeList<CurveHardening<LinearHardening>,
                              CurveHardening<BilinearHardening>,
                              CurveHardening<VoceHardening>,
                              CurveHardening<SwiftHardening>,
                              CurveHardening<LudwikHardening>,
                              JohnsonCookHardening,
                              CurveHardening<TableHardening>>;
} // namespace impm

#endif
