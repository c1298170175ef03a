#ifndef impm_input_choice_h
#define impm_input_choice_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <impm/base/names.h>
#include <impm/input/parameter_entries.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace impm
{
  /**
   * An entry that takes one of a few names, each of which stands for a value:
   * the one place that knows the names. The first one is the default.
   */
  template <typename Value>
  class Choice
  {
  public:
    struct Option
    {
      std::string name;
      Value       value;
    };

    Choice(const std::string &entry, const std::vector<Option> &options)
      : entry(entry)
      , options(options)
    {}

    /** In the subsection where the handler stands. */
    void
    declare(dealii::ParameterHandler &prm,
            const std::string        &documentation) const
    {
      prm.declare_entry(entry,
                        options.front().name,
                        dealii::Patterns::Selection(
                          join(names_of(options), "|")),
                        documentation);
    }

    /** What is chosen in a section ("Output/probe"), or else the default. */
    Value
    read(const Chosen &chosen, const std::string &section) const
    {
      const std::string name = chosen(section + "/" + entry, "");
      for (const auto &option : options)
        if (option.name == name)
          return option.value;
      return options.front().value;
    }

    const std::string &
    name_of(const Value value) const
    {
      for (const auto &option : options)
        if (option.value == value)
          return option.name;
      throw std::logic_error(entry + ": a choice has no name");
    }

    /** Whether the value is chosen in a section. */
    bool
    is(const Chosen      &chosen,
       const std::string &section,
       const Value        value) const
    {
      return chosen(section + "/" + entry, options.front().name) ==
             name_of(value);
    }

  private:
    std::string         entry;
    std::vector<Option> options;
  };
} // namespace impm

#endif
