#include <deal.II/base/utilities.h>

#include <deal.II/lac/vector.h>

#include <impm/input/expressions.h>
#include <impm/input/parameter_file.h>

#include <cmath>
#include <iostream>
#include <regex>
#include <sstream>

namespace impm
{
  using dealii::Point;

  namespace
  {
    /** The first one; the rest are likely to follow from it. */
    std::optional<InputError> flaw;
    bool                      is_trial = false;

    /** Remembers where a value arose that is not finite. */
    template <int n_variables>
    class WatchedParser : public dealii::FunctionParser<n_variables>
    {
    public:
      WatchedParser(const std::string &path, const unsigned int n_components)
        : dealii::FunctionParser<n_variables>(n_components)
        , path(path)
      {}

      double
      value(const Point<n_variables> &place,
            const unsigned int        component = 0) const override
      {
        const double value =
          dealii::FunctionParser<n_variables>::value(place, component);
        if (!std::isfinite(value))
          remember(value, place, component);
        return value;
      }

      void
      vector_value(const Point<n_variables> &place,
                   dealii::Vector<double>   &values) const override
      {
        for (unsigned int c = 0; c < this->n_components; ++c)
          values[c] = value(place, c);
      }

    private:
      void
      remember(const double              value,
               const Point<n_variables> &place,
               const unsigned int        component) const
      {
        if (is_trial || flaw)
          return;
        std::ostringstream what;
        what << "found '" << this->get_expressions()[component] << "', which "
             << (std::isnan(value) ? "is not a number" : "is infinite")
             << " at ";
        if (n_variables == 1)
          what << "t = " << place[0];
        else
          {
            for (unsigned int d = 0; d < n_variables; ++d)
              what << "xyz"[d] << " = " << place[d] << ", ";
            what << "t = " << this->get_time();
          }
        what << ": allowed are expressions with finite values";
        flaw.emplace(path, what.str());
      }

      const std::string path;
    };
  } // namespace

  template <int n_variables>
  std::shared_ptr<dealii::FunctionParser<n_variables>>
  read_expressions(const dealii::ParameterHandler      &prm,
                   const std::string                   &entry,
                   const unsigned int                   n_components,
                   const bool                           with_time,
                   const std::map<std::string, double> &constants,
                   bool                                *held)
  {
    using Parser           = dealii::FunctionParser<n_variables>;
    const std::string text = prm.get(entry);
    if (text.empty())
      return nullptr;
    auto expressions = dealii::Utilities::split_string_list(text, ';');
    if (expressions.size() != n_components)
      throw InputError(entry,
                       "found '" + text + "', allowed " +
                         (n_components == 1 ?
                            "is one expression" :
                            "are " + std::to_string(n_components) +
                              " expressions between semicolons"));

    for (unsigned int c = 0; held != nullptr && c < n_components; ++c)
      if (expressions[c] == "free")
        {
          held[c]        = false;
          expressions[c] = "0";
        }

    const std::string variables =
      n_variables == 1 ?
        "t" :
        Parser::default_variable_names() + (with_time ? ",t" : "");
    const auto function =
      std::make_shared<WatchedParser<n_variables>>(current_section() + entry,
                                                   n_components);

    // deal.II also prints muParser's message before it throws: report it once.
    std::ostringstream     printed, flaw;
    const auto             screen = std::cerr.rdbuf(printed.rdbuf());
    dealii::Vector<double> value(n_components);
    try
      {
        function->initialize(variables,
                             expressions,
                             constants,
                             with_time && n_variables > 1);
        // muParser compiles at the first use, which may be on another day.
        const ExpressionTrial trial;
        function->vector_value(Point<n_variables>(), value);
      }
    catch (const dealii::ExceptionBase &exception)
      {
        exception.print_info(flaw);
      }
    catch (...)
      {
        // muParser's own exceptions know no base class, and this is the one
        // place where deal.II lets them through.
        flaw << "a constant has a name that cannot stand in expressions";
      }
    std::cerr.rdbuf(screen);

    // Around muParser's message, deal.II calls the error's number a column.
    const auto said =
      dealii::Utilities::split_string_list(flaw.str(), "said: ");
    if (!said.empty())
      throw InputError(entry,
                       "found '" + text + "', allowed are expressions in " +
                         variables + " and the constants: " +
                         dealii::Utilities::trim(said.back()));
    if (!names_any_of<n_variables>(*function, "x|y|z|t|rand|rand_seed"))
      for (unsigned int c = 0; c < n_components; ++c)
        if (!std::isfinite(value[c]))
          throw InputError(entry,
                           "found '" + expressions[c] + "', which " +
                             (std::isnan(value[c]) ? "is not a number" :
                                                     "is infinite") +
                             ": allowed are expressions with finite values");
    return function;
  }

  std::optional<InputError>
  find_flaw(const MPI_Comm communicator)
  {
    namespace MPI              = dealii::Utilities::MPI;
    const unsigned int n_ranks = MPI::n_mpi_processes(communicator);
    if (n_ranks == 1)
      {
        const auto own = flaw ? std::optional<InputError>(*flaw) : std::nullopt;
        flaw.reset();
        return own;
      }
    const unsigned int first =
      MPI::min(flaw ? MPI::this_mpi_process(communicator) : n_ranks,
               communicator);
    if (first == n_ranks)
      return std::nullopt;
    const auto [entry, message] =
      MPI::broadcast(communicator,
                     flaw ? std::pair<std::string, std::string>(flaw->entry,
                                                                flaw->what()) :
                            std::pair<std::string, std::string>(),
                     first);
    flaw.reset();
    return InputError(entry, message);
  }

  void
  forget_flaw()
  {
    flaw.reset();
  }

  ExpressionTrial::ExpressionTrial()
    : was_on(is_trial)
  {
    is_trial = true;
  }

  ExpressionTrial::~ExpressionTrial()
  {
    is_trial = was_on;
  }

  template <int n_variables>
  bool
  names_any_of(const dealii::FunctionParser<n_variables> &function,
               const std::string                         &words)
  {
    const std::regex word("\\b(" + words + ")\\b");
    for (const auto &expression : function.get_expressions())
      if (std::regex_search(expression, word))
        return true;
    return false;
  }

  template std::shared_ptr<dealii::FunctionParser<1>>
  read_expressions(const dealii::ParameterHandler &,
                   const std::string &,
                   unsigned int,
                   bool,
                   const std::map<std::string, double> &,
                   bool *);
  template std::shared_ptr<dealii::FunctionParser<2>>
  read_expressions(const dealii::ParameterHandler &,
                   const std::string &,
                   unsigned int,
                   bool,
                   const std::map<std::string, double> &,
                   bool *);
  template std::shared_ptr<dealii::FunctionParser<3>>
  read_expressions(const dealii::ParameterHandler &,
                   const std::string &,
                   unsigned int,
                   bool,
                   const std::map<std::string, double> &,
                   bool *);
  template bool
  names_any_of(const dealii::FunctionParser<1> &, const std::string &);
  template bool
  names_any_of(const dealii::FunctionParser<2> &, const std::string &);
  template bool
  names_any_of(const dealii::FunctionParser<3> &, const std::string &);
} // namespace impm
