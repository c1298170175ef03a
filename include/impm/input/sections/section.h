#ifndef impm_input_sections_section_h
#define impm_input_sections_section_h

#include <deal.II/base/function_parser.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <impm/base/exceptions.h>
#include <impm/input/choice.h>
#include <impm/input/expressions.h>
#include <impm/input/parameter_file.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace impm
{
  namespace Patterns = dealii::Patterns;

  /** The default of a number and its closed range. */
  template <typename Number>
  struct Range
  {
    std::string fallback;
    Number      lower = std::numeric_limits<Number>::lowest(),
           upper      = std::numeric_limits<Number>::max();
  };

  /** Of expressions in x, y, z: how many there are, whether in t as well. */
  struct Form
  {
    unsigned int n_components;
    bool         is_in_time;
  };

  constexpr bool in_time = true, steady = false;

  constexpr double above_zero = std::numeric_limits<double>::min();

  /** Numbers that have names in the expressions of a file. */
  using Constants = std::map<std::string, double>;

  /**
   * A section of a parameter file. As with an archive of Boost.Serialization,
   * one and the same text declares its entries and reads them: every `add`
   * declares an entry, if that is asked for, and sets a variable to what the
   * file says of it so far, else to the default.
   *
   * Values are final, and checked, when the file is read. All errors are
   * InputErrors with the path of an entry.
   */
  class Section
  {
  public:
    /** The top of a file whose entries are declared... */
    Section(dealii::ParameterHandler &prm, const Chosen &chosen)
      : chosen(chosen)
      , is_read(false)
      , prm(&prm)
    {}

    /** ... or read. The handler stands at its top as long as this is used. */
    explicit Section(dealii::ParameterHandler &prm)
      : chosen(chosen_in(prm))
      , is_read(true)
      , prm(&prm)
    {}

    Section
    subsection(const std::string &name) const;

    void
    add(const std::string   &entry,
        double              &number,
        const Range<double> &range,
        const std::string   &documentation) const
    {
      const Patterns::Double pattern(range.lower, range.upper);
      number = dealii::Utilities::string_to_double(
        text(entry, range.fallback, pattern, documentation));
    }

    void
    add(const std::string &entry,
        unsigned int      &number,
        const Range<int>  &range,
        const std::string &documentation) const
    {
      const Patterns::Integer pattern(range.lower, range.upper);
      number = dealii::Utilities::string_to_int(
        text(entry, range.fallback, pattern, documentation));
    }

    void
    add(const std::string &entry,
        bool              &value,
        const bool         fallback,
        const std::string &documentation) const
    {
      value = text(entry,
                   fallback ? "true" : "false",
                   Patterns::Bool(),
                   documentation) == "true";
    }

    template <typename Value>
    void
    add(const Choice<Value> &choice,
        Value               &value,
        const std::string   &documentation) const
    {
      if (!is_read)
        inside([&](auto &prm) { choice.declare(prm, documentation); });
      value = choice.read(chosen, path);
    }

    /** The same for a choice that nobody else asks for. */
    template <typename Value>
    void
    add(const std::string                                 &entry,
        Value                                             &value,
        const std::vector<typename Choice<Value>::Option> &options,
        const std::string                                 &documentation) const
    {
      add(Choice<Value>(entry, options), value, documentation);
    }

    void
    add(const std::string &entry,
        std::string       &value,
        const std::string &documentation,
        const std::string &fallback = "") const
    {
      value = text(entry, fallback, Patterns::Anything(), documentation);
    }

    /** Adds an entry of a certain form. */
    std::string
    text(const std::string           &entry,
         const std::string           &fallback,
         const Patterns::PatternBase &pattern,
         const std::string           &documentation) const;

    /** Between commas. */
    void
    add(const std::string        &entry,
        std::vector<std::string> &names,
        const std::string        &documentation,
        const std::string        &fallback = "") const
    {
      names =
        split_names(text(entry, fallback, Patterns::Anything(), documentation));
    }

    /** None where the entry is empty, which is the default. */
    void
    add(const std::string     &entry,
        std::optional<double> &number,
        const std::string     &documentation) const;

    /** See read_expressions(). */
    template <int n_variables>
    void
    add(const std::string                                    &entry,
        std::shared_ptr<dealii::FunctionParser<n_variables>> &function,
        const Form                                           &form,
        const std::string                                    &documentation,
        const std::string &fallback = "") const
    {
      text(entry, fallback, Patterns::Anything(), documentation);
      if (is_read)
        inside([&](const auto &prm) {
          function = read_expressions<n_variables>(
            prm, entry, form.n_components, form.is_in_time, constants);
        });
    }

    /** The same of a motion, a component of which may be 'free': it is not
     * held then. At least one is. */
    template <int dim, std::size_t n_components>
    void
    add(const std::string                            &entry,
        std::shared_ptr<dealii::FunctionParser<dim>> &function,
        std::array<bool, n_components>               &held,
        const std::string                            &documentation) const
    {
      text(entry, "", Patterns::Anything(), documentation);
      if (!is_read)
        return;
      inside([&](const auto &prm) {
        function = read_expressions<dim>(
          prm, entry, n_components, in_time, constants, held.data());
      });
      if (std::count(held.begin(), held.end(), true) == 0)
        refuse(entry, "allowed is at least one component that is not free");
    }

    /** Adds an entry of `n` numbers between commas; zeros when not read. */
    std::vector<double>
    numbers(const std::string           &entry,
            const unsigned int           n,
            const std::string           &documentation,
            const std::string           &fallback = "",
            const Patterns::PatternBase &pattern  = Patterns::Anything()) const;

    /** Adds an entry with the names of subsections, all different, which may
     * be switched off: returns the others. */
    std::vector<std::string>
    names(const std::string &entry, const std::string &documentation) const;

    /** Adds the name of one of some items, the first one by default. */
    template <typename Item>
    const Item &
    pick(const std::string       &entry,
         const std::vector<Item> &items,
         const std::string       &documentation) const
    {
      const auto known = names_of(items);
      const auto name  = text(entry,
                             known.front(),
                             Patterns::Selection(join(known, "|")),
                             documentation);
      return items[std::find(known.begin(), known.end(), name) - known.begin()];
    }

    /** Whether the value is chosen. */
    template <typename Value>
    bool
    chooses(const Choice<Value> &choice, const Value value) const
    {
      return choice.is(chosen, path, value);
    }

    /** What the file says so far. */
    std::string
    get(const std::string &entry) const
    {
      return chosen(path + "/" + entry, "");
    }

    /** Throws the message if the file is read. */
    void
    fail(const std::string &entry, const std::string &message) const
    {
      if (is_read)
        throw InputError(path + "/" + entry, message);
    }

    /** The same: "found '...', " and what is wrong with it. */
    void
    refuse(const std::string &entry, const std::string &flaw) const
    {
      fail(entry, "found '" + get(entry) + "', " + flaw);
    }

    /** The same where the entry is empty: "is an expression". */
    void
    require(const std::string &entry, const std::string &allowed) const
    {
      if (get(entry).empty())
        refuse(entry, "allowed " + allowed);
    }

    /** The same for a name in the entry that is not among those allowed. */
    void
    require_name(const std::string              &entry,
                 const std::string              &found,
                 const std::vector<std::string> &allowed) const
    {
      if (is_read)
        impm::require_name(allowed, found, path + "/" + entry);
    }

    /** Runs the action with the handler in this section. */
    void
    inside(const std::function<void(dealii::ParameterHandler &)> &action) const
    {
      in_section(*prm, path, [&]() { action(*prm); });
    }

    std::string name;
    std::string path; ///< "Output/probe"
    Chosen      chosen;
    Constants   constants; ///< that expressions may use
    bool        is_read;   ///< rather than declared

  private:
    dealii::ParameterHandler *prm;
  };
} // namespace impm

#endif
