#include <impm/input/sections/contact.h>

#include <algorithm>

namespace impm
{
  namespace
  {
    /** Whether a pair is glued, else its kind. */
    struct Kind
    {
      bool        is_glued = true;
      ContactKind kind     = ContactKind::bonded;

      bool
      operator==(const Kind &other) const
      {
        return is_glued == other.is_glued && kind == other.kind;
      }
    };

    template <int dim>
    unsigned int
    number_of(const std::string &name, const Bodies<dim> &bodies)
    {
      return std::find_if(bodies.begin(),
                          bodies.end(),
                          [&](const auto &body) { return body.name == name; }) -
             bodies.begin();
    }

    /** Sets both bodies of a pair; the first is deformable. */
    template <int dim>
    void
    add_bodies_of_pair(const Section     &section,
                       const Bodies<dim> &bodies,
                       ContactPair       &pair)
    {
      std::vector<std::string> names;
      section.add("Bodies",
                  names,
                  "Two: a deformable one and another, a rigid one, or a face "
                  "of the domain. Of two deformable ones the surface of the "
                  "first is followed for bonds, those of both for contact.");
      auto deformable = names_of_bodies(bodies, false);
      auto rigid      = names_of_bodies(bodies, true);
      if (names.size() != 2 || names[0] == names[1])
        {
          section.refuse("Bodies", "allowed are two different names");
          return; // when declaring
        }
      if (std::count(deformable.begin(), deformable.end(), names[0]) == 0)
        std::swap(names[0], names[1]);
      section.require_name("Bodies", names[0], deformable);
      pair.body   = number_of(names[0], bodies);
      auto others = deformable;
      others.insert(others.end(), rigid.begin(), rigid.end());
      others.insert(others.end(),
                    face_names().begin(),
                    face_names().begin() + 2 * dim);
      section.require_name("Bodies", names[1], others);
      pair.partner = number_of(names[1], bodies);
      if (pair.partner < bodies.size() && bodies[pair.partner].rigid &&
          !bodies[pair.partner].meets_surfaces)
        section.refuse("Bodies",
                       "allowed are rigid bodies with 'Contact = surface'");
      if (pair.partner < bodies.size())
        pair.partner_kind = bodies[pair.partner].rigid ?
                              PartnerKind::rigid :
                              PartnerKind::deformable;
      else
        {
          pair.partner_kind = PartnerKind::face;
          pair.partner =
            std::find(face_names().begin(), face_names().end(), names[1]) -
            face_names().begin();
        }
      for (const unsigned int b : {pair.body, pair.partner})
        if ((b == pair.body || pair.partner_kind != PartnerKind::face) &&
            b < bodies.size() && !bodies[b].shape)
          section.refuse("Bodies",
                         "allowed are bodies with a 'Shape', which has a "
                         "surface; '" +
                           bodies[b].name + "' comes from a file");
    }

    template <int dim>
    void
    add_pair(const Section     &section,
             const Bodies<dim> &bodies,
             ContactPair       &pair,
             bool              &is_glued)
    {
      pair.name = section.name;
      add_bodies_of_pair(section, bodies, pair);
      Kind kind;
      section.add("Kind",
                  kind,
                  {{"frictionless", {false, ContactKind::frictionless}},
                   {"Coulomb", {false, ContactKind::coulomb}},
                   {"bonded", {false, ContactKind::bonded}},
                   {"glue", {}}},
                  "Frictionless, Coulomb: surfaces that meet press on each "
                  "other, slide and part. Bonded: each body moves nodes of its "
                  "own, and surfaces that touch at the start stay together. "
                  "Glue: both move the same nodes, as bodies do that no pair "
                  "names, and so meet as soon as they come to one cell, and "
                  "never part again.");
      is_glued  = kind.is_glued;
      pair.kind = kind.kind;
      if (pair.partner_kind != PartnerKind::deformable &&
          (is_glued || pair.kind == ContactKind::bonded))
        section.refuse("Kind",
                       "allowed with a rigid body or a face are frictionless, "
                       "Coulomb");
      if (pair.kind == ContactKind::coulomb)
        section.add("Friction coefficient",
                    pair.friction,
                    {"0.1", 0, 10},
                    "Largest friction over pressure.");
    }

    /** Gives bodies that are glued, perhaps by way of others, one layer. */
    template <int dim>
    void
    choose_layers(const Section                  &section,
                  const std::vector<ContactPair> &pairs,
                  Bodies<dim>                    &bodies,
                  GridSpec<dim>                  &grid)
    {
      const auto apart = [&](const unsigned int a, const unsigned int b) {
        return std::any_of(pairs.begin(), pairs.end(), [&](const auto &pair) {
          return pair.partner_kind == PartnerKind::deformable &&
                 std::minmax(a, b) == std::minmax(pair.body, pair.partner);
        });
      };
      const unsigned int        none = bodies.size();
      std::vector<unsigned int> layers(bodies.size(), none);
      unsigned int              n = 0;
      for (unsigned int first = 0; first < bodies.size(); ++first)
        {
          if (bodies[first].rigid || layers[first] != none)
            continue;
          std::vector<unsigned int> found = {first};
          layers[first]                   = n;
          for (unsigned int i = 0; i < found.size(); ++i)
            for (unsigned int b = 0; b < bodies.size(); ++b)
              if (!bodies[b].rigid && layers[b] == none && !apart(found[i], b))
                {
                  layers[b] = n;
                  found.push_back(b);
                }
          for (const unsigned int a : found)
            for (const unsigned int b : found)
              if (a < b && apart(a, b))
                section.refuse("Pairs",
                               "which keep '" + bodies[a].name + "' and '" +
                                 bodies[b].name +
                                 "' apart, while both are glued to another "
                                 "body: allowed are pairs that name how they "
                                 "meet that one, too");
          ++n;
        }
      for (unsigned int b = 0; b < bodies.size(); ++b)
        bodies[b].layer = bodies[b].rigid ? 0 : layers[b];
      grid.n_layers = std::max(n, 1u);
    }

    /** Faces hold whole layers, or none of their nodes. */
    template <int dim>
    void
    let_go(const Section                  &section,
           const std::vector<ContactPair> &pairs,
           const Bodies<dim>              &bodies,
           Faces<dim>                     &faces)
    {
      const auto meet = [&](const unsigned int body, const auto &pair) {
        return std::any_of(pairs.begin(), pairs.end(), [&](const auto &other) {
          return other.body == body &&
                 other.partner_kind == pair.partner_kind &&
                 other.partner == pair.partner;
        });
      };
      for (const auto &pair : pairs)
        if (pair.partner_kind == PartnerKind::face)
          {
            const auto        &face  = faces[pair.partner];
            const unsigned int layer = bodies[pair.body].layer;
            if (face.value && !face.moves_grid)
              section.refuse("Pairs",
                             "where '" + pair.name + "' names '" + face.name +
                               "', which is to move: allowed are faces at "
                               "rest, and such as move the grid");
            for (unsigned int b = 0; b < bodies.size(); ++b)
              if (!bodies[b].rigid && bodies[b].layer == layer &&
                  !meet(b, pair))
                section.refuse("Pairs",
                               "where '" + pair.name + "' frees '" +
                                 bodies[pair.body].name + "' from '" +
                                 faces[pair.partner].name + "', while '" +
                                 bodies[b].name +
                                 "', which is glued to it, has no pair with "
                                 "that face");
            faces[pair.partner].released_layers.push_back(layer);
          }
    }

    /** Bodies that are glued to each other by saying nothing, with another one
     * in between. `glued` are those of which the scene says so. */
    template <int dim>
    void
    check_glue(const std::vector<ContactPair> &pairs,
               const std::vector<ContactPair> &glued,
               const Bodies<dim>              &bodies,
               std::vector<std::string>       &warnings)
    {
      const auto are_in =
        [](const auto &list, const unsigned int a, const unsigned int b) {
          return std::any_of(list.begin(), list.end(), [&](const auto &pair) {
            return pair.partner_kind != PartnerKind::face &&
                   std::minmax(a, b) == std::minmax(pair.body, pair.partner);
          });
        };
      const auto are_apart = [&](const auto &a, const auto &b) {
        return a.shape && b.shape && a.shape->bounding_box &&
               b.shape->bounding_box &&
               a.shape->bounding_box->get_neighbor_type(
                 *b.shape->bounding_box) == dealii::NeighborType::not_neighbors;
      };
      for (unsigned int a = 0; a < bodies.size(); ++a)
        for (unsigned int b = a + 1; b < bodies.size(); ++b)
          for (unsigned int c = 0; c < bodies.size(); ++c)
            if (!bodies[a].rigid && !bodies[b].rigid && are_in(pairs, a, c) &&
                are_in(pairs, b, c) && !are_in(pairs, a, b) &&
                !are_in(glued, a, b) && are_apart(bodies[a], bodies[b]))
              warnings.push_back(
                "no pair of the section Contact names '" + bodies[a].name +
                "' and '" + bodies[b].name + "', which both meet '" +
                bodies[c].name +
                "': they are glued to each other as soon as both come to one "
                "cell, be it between them");
    }

    /** What rigid bodies pass through. */
    template <int dim>
    void
    check_rigid_bodies(const Section                  &section,
                       const std::vector<ContactPair> &pairs,
                       const Bodies<dim>              &bodies,
                       std::vector<std::string>       &warnings)
    {
      for (unsigned int r = 0; r < bodies.size(); ++r)
        if (bodies[r].meets_surfaces)
          {
            std::vector<std::string> others;
            for (unsigned int b = 0; b < bodies.size(); ++b)
              if (!bodies[b].rigid &&
                  std::none_of(pairs.begin(), pairs.end(), [&](const auto &q) {
                    return q.body == b &&
                           q.partner_kind == PartnerKind::rigid &&
                           q.partner == r;
                  }))
                others.push_back(bodies[b].name);
            if (others.size() == names_of_bodies(bodies, false).size())
              section.refuse("Pairs",
                             "allowed is at least one with '" + bodies[r].name +
                               "', whose Contact is its surface");
            if (bodies[r].is_free && names_of_bodies(bodies, true).size() > 1)
              warnings.push_back("free rigid body '" + bodies[r].name +
                                 "' passes through other rigid bodies: only "
                                 "deformable ones meet it");
            if (!others.empty())
              warnings.push_back("rigid body '" + bodies[r].name +
                                 "' passes through " + join(others, ", ") +
                                 ", which no pair of the section Contact "
                                 "names with it");
          }
    }
  } // namespace

  template <int dim>
  void
  add_contact(const Section            &top,
              ContactSpec              &contact,
              Bodies<dim>              &bodies,
              Faces<dim>               &faces,
              GridSpec<dim>            &grid,
              std::vector<std::string> &warnings)
  {
    const auto section = top.subsection("Contact");
    const auto names   = section.names(
      "Pairs",
      "Names of pairs of bodies, each with a subsection; those that none names "
        "are glued to each other.");
    if (names.empty() &&
        std::none_of(bodies.begin(), bodies.end(), [](const auto &body) {
          return body.meets_surfaces;
        }))
      return;
    if (grid.keeps_motion())
      section.refuse("Pairs",
                     "allowed on a grid that keeps its motion ('Grid/Method = "
                     "Lagrangian', 'Grid/Reset') is none");
    section.add(
      "Thickness",
      contact.thickness,
      {"0.1", 1e-4, 0.5},
      "Of the layer of bodies, in cells, that gives way where surfaces "
      "press on each other. It is as stiff as the softer of both "
      "bodies.");
    std::vector<ContactPair> glued;
    for (const auto &name : names)
      {
        ContactPair pair;
        bool        is_glued = false;
        add_pair(section.subsection(name), bodies, pair, is_glued);
        for (const auto &other : contact.pairs)
          if (section.is_read && other.partner_kind == pair.partner_kind &&
              ((other.body == pair.body && other.partner == pair.partner) ||
               (pair.partner_kind == PartnerKind::deformable &&
                other.body == pair.partner && other.partner == pair.body)))
            section.subsection(name).refuse("Bodies",
                                            "which make the pair '" +
                                              other.name + "' already");
        (is_glued ? glued : contact.pairs).push_back(pair);
      }
    if (!section.is_read)
      {
        contact.pairs.clear();
        return;
      }
    choose_layers(section, contact.pairs, bodies, grid);
    let_go(section, contact.pairs, bodies, faces);
    check_rigid_bodies(section, contact.pairs, bodies, warnings);
    check_glue(contact.pairs, glued, bodies, warnings);
  }

  template void
  add_contact(const Section &,
              ContactSpec &,
              Bodies<2> &,
              Faces<2> &,
              GridSpec<2> &,
              std::vector<std::string> &);
  template void
  add_contact(const Section &,
              ContactSpec &,
              Bodies<3> &,
              Faces<3> &,
              GridSpec<3> &,
              std::vector<std::string> &);
} // namespace impm
