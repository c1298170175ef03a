#include <impm/input/sections/heat.h>

#include <algorithm>

namespace impm
{
  template <int dim>
  void
  add_heat(const Section            &top,
           HeatSpec<dim>            &heat,
           const Bodies<dim>        &bodies,
           const ContactSpec        &contact,
           std::vector<std::string> &warnings)
  {
    const auto section = top.subsection("Heat");
    heat.is_conducted =
      std::any_of(bodies.begin(), bodies.end(), [](const auto &body) {
        return !body.rigid && body.material && body.material->conducts();
      });
    const auto require_conduction = [&](const Section     &place,
                                        const std::string &entry) {
      if (!heat.is_conducted && !place.get(entry).empty())
        place.refuse(entry,
                     "allowed where no body has a 'Conductivity' is nothing");
    };
    section.add("Source",
                heat.source,
                {1, in_time},
                "Heat for each mass and time (W/kg) in what conducts: an "
                "expression in x, y, z, t; empty: none.");
    require_conduction(section, "Source");
    for (unsigned int f = 0; f < 2 * dim; ++f)
      {
        const auto face = section.subsection(face_names()[f]);
        face.add("Temperature",
                 heat.temperatures[f],
                 {1, in_time},
                 "(K), an expression in x, y, z, t, of the nodes on this face "
                 "of the domain that have material; empty: the face is "
                 "insulated.");
        require_conduction(face, "Temperature");
      }
    if (heat.is_conducted && !contact.pairs.empty())
      warnings.push_back(
        "surfaces that meet (section Contact) exchange no heat "
        "and friction does not heat them");
  }

  template void
  add_heat(const Section &,
           HeatSpec<2> &,
           const Bodies<2> &,
           const ContactSpec &,
           std::vector<std::string> &);
  template void
  add_heat(const Section &,
           HeatSpec<3> &,
           const Bodies<3> &,
           const ContactSpec &,
           std::vector<std::string> &);
} // namespace impm
