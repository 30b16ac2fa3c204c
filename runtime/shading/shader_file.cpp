// SPDX-License-Identifier: MIT
#include "runtime/shading/shader_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>

#include "base/errors.h"
#include "base/files.h"
#include "runtime/shading/shader_tokens.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

using Token = ShaderToken;
using Kind = ShaderParameter::Kind;

constexpr std::array<std::pair<const char*, ShaderType>, 5> types = {{{"float", ShaderType::real},
                                                                      {"int", ShaderType::integer},
                                                                      {"vec2", ShaderType::vec2},
                                                                      {"vec3", ShaderType::vec3},
                                                                      {"vec4", ShaderType::vec4}}};
constexpr const char* type_names = "float, int, vec2, vec3 or vec4";
constexpr const char* before_name = "before_light";
constexpr const char* after_name = "after_light";
constexpr const char* before_signature = "void before_light(Surface surface, inout Appearance appearance)";
constexpr const char* after_signature = "vec3 after_light(Surface surface, Appearance appearance, Light light)";

/// Words that nothing can be named by.
const std::set<std::string> keywords = {
    "float",  "int",     "uint",    "bool",   "vec2", "vec3",   "vec4",      "ivec2",  "ivec3", "ivec4",    "uvec2",
    "uvec3",  "uvec4",   "mat2",    "mat3",   "mat4", "void",   "struct",    "const",  "in",    "out",      "inout",
    "if",     "else",    "for",     "while",  "do",   "switch", "case",      "return", "break", "continue", "discard",
    "layout", "uniform", "varying", "buffer", "true", "false",  "parameter", "texture"};

/// Qualifiers that may stand before the type of a global variable or of a function.
const std::set<std::string> qualifiers = {"const", "highp", "mediump", "lowp", "precise"};

/// Reads the outline of a shader's file, statement by statement.
class ShaderReader {
 public:
  ShaderReader(const std::string& text, const fs::path& file) : text_(without_comments(text)) {
    shader_.file = file;
    shader_.name = file.stem().string();
    tokens_ = shader_tokens(text_);
    shader_.text = text_;
  }

  SurfaceShader read() {
    while (at_ < tokens_.size()) read_statement();
    for (const auto& [name, signature] : {std::pair{before_name, before_signature}, {after_name, after_signature}})
      if (functions_.count(name) == 0)
        fail(1, std::string("has no function ") + name, std::string("'") + signature + " { ... }'", "add it");
    if (shader_.varying_components() > most_varying_components)
      fail(last_varying_->line,
           "the varying parameters have " + std::to_string(shader_.varying_components()) + " components together",
           "at most " + std::to_string(most_varying_components),
           "compute what follows from the others in before_light");
    return std::move(shader_);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& found, const std::string& expected,
                         const std::string& remedy) const {
    throw BadInput(shader_.file.string() + ":" + std::to_string(line), found, expected, remedy);
  }

  const Token& next() const {
    static const Token none{Token::Kind::sign, "the end of the file", 0, 0, 0};
    if (at_ < tokens_.size()) return tokens_[at_];
    return none;
  }
  int line() const { return at_ < tokens_.size() ? next().line : tokens_.empty() ? 1 : tokens_.back().line; }
  bool is_next(const std::string& text) const {
    return at_ < tokens_.size() && next().text == text && next().kind != Token::Kind::text;
  }
  [[noreturn]] void fail_here(const std::string& expected, const std::string& remedy) const {
    fail(line(), "found '" + next().text + "'", expected, remedy);
  }
  Token take(const std::string& text, const std::string& remedy) {
    if (!is_next(text)) fail_here("'" + text + "'", remedy);
    return tokens_[at_++];
  }

  /// Takes over a name that the file defines; functions may have several definitions.
  void define(const Token& token, bool is_function = false) {
    const std::string& name = token.text;
    if (keywords.count(name) > 0 || name.rfind("gl_", 0) == 0)
      fail(token.line, "found the name '" + name + "'", "a name that is no word of GLSL", "choose another name");
    const bool fresh = shader_.names.insert(name).second;
    if (!fresh && !(is_function && functions_.count(name) > 0))
      fail(token.line, "'" + name + "' is declared a second time, after line " + std::to_string(lines_[name]),
           "one declaration of each name", "rename or remove one of them");
    if (is_function) functions_.insert(name);
    lines_.emplace(name, token.line);
  }

  void read_statement() {
    const Token first = next();
    if (first.kind == Token::Kind::directive) return read_directive();
    for (const auto& [word, kind] : {std::pair{"parameter", Kind::constant},
                                     {"uniform", Kind::uniform},
                                     {"varying", Kind::varying},
                                     {"texture", Kind::texture}})
      if (is_next(word)) return read_parameter(kind);
    for (const char* word : {"in", "out", "layout", "buffer", "shared", "precision"})
      if (is_next(word))
        fail_here("a parameter, a uniform, a texture, a varying, a global variable or a function",
                  "declare what the shader reads as docs/shaders.md says");
    read_glsl();
  }

  void read_directive() {
    const std::vector<Token> words = shader_tokens(next().text.substr(1));
    const std::string command = words.empty() ? "" : words.front().text;
    for (const char* word : {"version", "line", "include", "extension", "pragma"})
      if (command == word)
        fail_here("GLSL 4.50 without #version, #line, #include, #extension and #pragma", "remove the line");
    if (command == "define" && words.size() > 1) {
      Token name = words[1];
      name.line = line();
      define(name);
    }
    ++at_;
  }

  ShaderType read_type() {
    for (const auto& [word, type] : types)
      if (is_next(word)) {
        ++at_;
        return type;
      }
    fail(line(), "found the type '" + next().text + "'", type_names, "choose one of these types");
  }

  double read_number() {
    const bool negative = is_next("-");
    if (negative) ++at_;
    double number = 0;
    const std::string& text = next().text;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (next().kind != Token::Kind::number || fault != std::errc() || end != text.data() + text.size())
      fail_here("a number", "write defaults and ranges as numbers; what is computed is a uniform");
    ++at_;
    return negative ? -number : number;
  }

  /// Reads the value of a constant: a number, or TYPE(numbers).
  ShaderValue read_value(ShaderType type) {
    ShaderValue value{};
    const auto count = static_cast<std::size_t>(component_count(type));
    if (count == 1) {
      value[0] = static_cast<float>(read_number());
      if (type == ShaderType::integer && value[0] != static_cast<float>(static_cast<int>(value[0])))
        fail(line(), "found a fraction", "an int", "write a whole number, or make it a float");
      return value;
    }
    const int begun = line();
    take(glsl_type(type), std::string("write the value as ") + glsl_type(type) + "(...)");
    take("(", "write its components between parentheses");
    std::vector<float> numbers = {static_cast<float>(read_number())};
    while (is_next(",")) {
      ++at_;
      numbers.push_back(static_cast<float>(read_number()));
    }
    take(")", "write numbers between commas");
    if (numbers.size() == 1) numbers.resize(count, numbers.front());
    if (numbers.size() != count)
      fail(begun, "found " + std::to_string(numbers.size()) + " components", "1 or " + std::to_string(count),
           "give each component, or one number for all");
    std::copy(numbers.begin(), numbers.end(), value.begin());
    return value;
  }

  /// Reads GLSL up to the semicolon.
  std::string read_expression() {
    const std::size_t begin = next().begin;
    int depth = 0;
    while (at_ < tokens_.size() && !(depth == 0 && is_next(";"))) {
      if (is_next("(") || is_next("[")) ++depth;
      if (is_next(")") || is_next("]")) --depth;
      if (is_next("{") || is_next("}")) fail_here("an expression that ends with ';'", "add the semicolon");
      ++at_;
    }
    const std::string expression = text_.substr(begin, (at_ < tokens_.size() ? next().begin : text_.size()) - begin);
    if (expression.empty()) fail_here("an expression of GLSL", "say what it is equal to");
    return expression;
  }

  void read_parameter(Kind kind) {
    const std::size_t first = at_++;
    ShaderParameter parameter;
    parameter.kind = kind;
    if (kind != Kind::texture) parameter.type = read_type();
    if (next().kind != Token::Kind::word) fail_here("a name", "name the parameter");
    const Token name = tokens_[at_++];
    parameter.name = name.text;
    parameter.line = name.line;
    define(name);
    take("=", kind == Kind::texture ? "name the picture's file" : "every parameter has a value by default");
    if (kind == Kind::constant) {
      parameter.value = read_value(parameter.type);
      if (is_next("in")) read_range(parameter);
    } else if (kind == Kind::texture) {
      read_picture(parameter);
    } else {
      if (kind == Kind::varying && parameter.type == ShaderType::integer)
        fail(parameter.line, "found a varying int", "float, vec2, vec3 or vec4", "what is interpolated has fractions");
      parameter.expression = read_expression();
    }
    take(";", "end the declaration with a semicolon");
    // Blanks the declaration, so that what stays is GLSL on the same lines.
    for (std::size_t k = tokens_[first].begin; k < tokens_[at_ - 1].end; ++k)
      if (shader_.text[k] != '\n') shader_.text[k] = ' ';
    shader_.parameters.push_back(std::move(parameter));
    if (kind == Kind::varying) last_varying_ = shader_.parameters.back();
  }

  void read_range(ShaderParameter& parameter) {
    ++at_;
    parameter.has_range = true;
    parameter.lowest = static_cast<float>(read_number());
    take("to", "write a range as 'in LOWEST to HIGHEST'");
    parameter.highest = static_cast<float>(read_number());
    for (int c = 0; c < component_count(parameter.type); ++c)
      if (!(parameter.value[static_cast<std::size_t>(c)] >= parameter.lowest &&
            parameter.value[static_cast<std::size_t>(c)] <= parameter.highest))
        fail(parameter.line, "the default of '" + parameter.name + "' is outside its range", "one within it",
             "change the default or the range");
  }

  void read_picture(ShaderParameter& parameter) {
    if (next().kind != Token::Kind::text || next().text.empty())
      fail_here("the name of a picture between quotes", "name it, relative to the shader's folder");
    parameter.picture = tokens_[at_++].text;
    while (is_next("linear") || is_next("clamped")) {
      (is_next("linear") ? parameter.is_linear : parameter.is_clamped) = true;
      ++at_;
    }
  }

  /// Passes over a global variable or a function, whose names it takes.
  void read_glsl() {
    const std::size_t first = at_;
    std::vector<std::size_t> open;  // parentheses and braces
    bool is_assigned = false, is_function = false, expects_name = true;
    while (at_ < tokens_.size()) {
      const Token& token = tokens_[at_];
      if (token.kind == Token::Kind::directive) {
        read_directive();
        continue;
      }
      if (open.empty() && token.kind == Token::Kind::word && !is_assigned && !is_function && expects_name &&
          is_name(first)) {
        is_function = at_ + 1 < tokens_.size() && tokens_[at_ + 1].text == "(";
        define(token, is_function);
        if (is_function) check_part(first, at_);
        expects_name = false;
      } else if (open.empty() && token.text == "=")
        is_assigned = true;
      else if (open.empty() && token.text == ",")
        is_assigned = false, expects_name = true;
      const bool closes = token.text == ")" || token.text == "}" || token.text == "]";
      if (token.text == "(" || token.text == "{" || token.text == "[") open.push_back(at_);
      if (closes) {
        const char* partner = token.text == ")" ? "(" : token.text == "}" ? "{" : "[";
        if (open.empty() || tokens_[open.back()].text != partner)
          fail(token.line, "found '" + token.text + "' without its partner", std::string("'") + partner + "' before it",
               "remove it or add the other");
        open.pop_back();
      }
      ++at_;
      if (open.empty() && (token.text == ";" || (token.text == "}" && is_function))) return;
    }
    const Token& left = open.empty() ? tokens_[first] : tokens_[open.front()];
    fail(left.line, "found '" + left.text + "' without its end", open.empty() ? "';'" : "its partner",
         "close it before the end of the file");
  }

  /// Throws unless the function from `first` on, named at `name`, is none of the two parts or has that part's
  /// signature, whatever its parameters are called.
  void check_part(std::size_t first, std::size_t name) const {
    const bool is_before = tokens_[name].text == before_name;
    if (!is_before && tokens_[name].text != after_name) return;
    const std::string signature = is_before ? before_signature : after_signature;
    const std::vector<Token> expected = shader_tokens(signature);
    bool good = first + expected.size() <= tokens_.size();
    for (std::size_t k = 0; good && k < expected.size(); ++k) {
      const bool is_parameter = k + 1 < expected.size() && (expected[k + 1].text == "," || expected[k + 1].text == ")");
      good = is_parameter ? tokens_[first + k].kind == Token::Kind::word : tokens_[first + k].text == expected[k].text;
    }
    if (!good)
      fail(tokens_[name].line, "'" + tokens_[name].text + "' has other parameters or another result",
           "'" + signature + "'", "write it so");
  }

  /// Tests whether the word at hand names something that the statement from `first` on defines: the second word that is
  /// no qualifier, or one behind a comma.
  bool is_name(std::size_t first) const {
    if (tokens_[at_ - (at_ > first ? 1 : 0)].text == "," && at_ > first) return true;
    std::size_t words = 0;
    for (std::size_t k = first; k < at_; ++k)
      if (tokens_[k].kind == Token::Kind::word && qualifiers.count(tokens_[k].text) == 0) ++words;
    return words == 1;
  }

  std::string text_;
  SurfaceShader shader_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::set<std::string> functions_;
  std::map<std::string, int> lines_;
  std::optional<ShaderParameter> last_varying_;
};

}  // namespace

const char* glsl_type(ShaderType type) {
  for (const auto& [word, known] : types)
    if (known == type) return word;
  return "";
}

int component_count(ShaderType type) {
  switch (type) {
    case ShaderType::vec2:
      return 2;
    case ShaderType::vec3:
      return 3;
    case ShaderType::vec4:
      return 4;
    default:
      return 1;
  }
}

const ShaderParameter* SurfaceShader::find(const std::string& wanted) const {
  for (const ShaderParameter& parameter : parameters)
    if (parameter.name == wanted) return &parameter;
  return nullptr;
}

int SurfaceShader::varying_components() const {
  int count = 0;
  for (const ShaderParameter& parameter : parameters)
    if (parameter.kind == Kind::varying) count += component_count(parameter.type);
  return count;
}

SurfaceShader parse_shader(const std::string& text, const fs::path& file) { return ShaderReader(text, file).read(); }

SurfaceShader read_shader(const fs::path& file) { return parse_shader(read_text(file), file); }

std::vector<SurfaceShader> read_shaders(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code fault;
  for (fs::directory_iterator entry(folder, fault), end; !fault && entry != end; entry.increment(fault))
    if (entry->path().extension() == ".glsl") files.push_back(entry->path());
  if (files.empty())
    throw BadInput(folder.string(), "holds no shader", "files NAME.glsl", "name the folder that holds the shaders");
  std::sort(files.begin(), files.end());
  std::vector<SurfaceShader> shaders;
  for (const fs::path& file : files) shaders.push_back(read_shader(file));
  return shaders;
}

std::string with_prefix(const std::string& glsl, const std::set<std::string>& names, const std::string& prefix) {
  std::string renamed;
  std::size_t copied = 0;
  char before = ' ';
  const auto rename = [&](std::size_t at) {
    renamed += glsl.substr(copied, at - copied) + prefix;
    copied = at;
  };
  for (const ShaderToken& token : shader_tokens(glsl)) {
    if (token.kind == ShaderToken::Kind::directive) {  // words behind the command
      char inside = ' ';
      for (const ShaderToken& word : shader_tokens(token.text.substr(1))) {
        if (word.begin > 0 && inside != '.' && names.count(word.text) > 0) rename(token.begin + 1 + word.begin);
        inside = word.text.back();
      }
    } else if (token.kind == ShaderToken::Kind::word && before != '.' && names.count(token.text) > 0) {
      rename(token.begin);
    }
    if (!token.text.empty()) before = token.text.back();
  }
  return renamed + glsl.substr(copied);
}

}  // namespace kiln
