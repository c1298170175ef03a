#include <impm/base/exceptions.h>
#include <impm/base/files.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace impm
{
  std::string
  content_of(const std::string &file_name)
  {
    std::ifstream      file(file_name);
    std::ostringstream content;
    content << file.rdbuf();
    return content.str();
  }

  void
  replace_file(const std::string &name, const std::string &content)
  {
    const std::string temporary = name + ".new";
    std::ofstream     file(temporary);
    file << content;
    file.close();
    if (!file || std::rename(temporary.c_str(), name.c_str()) != 0)
      throw SystemError("cannot write '" + name + "'");
  }
} // namespace impm
