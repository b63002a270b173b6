#include "host/glsl_test/function.h"

#include <algorithm>
#include <cstring>

#include "host/glsl_test/source.h"

namespace solidcast::glsl_test {

// --- results --------------------------------------------------------------------------------------

struct Output::Data {
  struct Item {
    std::string name;
    Type type;
    std::vector<std::byte> bytes;
  };
  std::size_t count = 0;
  std::vector<Item> outputs;
  std::vector<std::pair<std::string, Values>> inputs;
  double median = 0, least = 0, most = 0;  // ns an element
};

const std::string& Output::name() const { return data_->outputs[which_].name; }
Type Output::type() const { return data_->outputs[which_].type; }
std::size_t Output::count() const { return data_->count; }
const std::byte* Output::element(std::size_t i) const {
  return data_->outputs[which_].bytes.data() + i * type().bytes();
}

void Output::requireType(Type wanted) const {
  if (wanted == type()) return;
  throw Error(Exit::usage,
              "\"" + name() + "\" is " + glsl_test::name(type()) + ", but was read as " + glsl_test::name(wanted));
}

std::string Output::inputsOf(std::size_t i) const {
  std::string out;
  for (const auto& [parameter, values] : data_->inputs) {
    const std::size_t at = values.shared() ? 0 : i;
    out += "    " + parameter + " = " + text(values.type(), values.bytes().data() + at * values.type().bytes()) + "\n";
  }
  return out;
}

Output Call::operator[](const std::string& name) const {
  std::string known;
  for (std::size_t i = 0; i < data_->outputs.size(); ++i) {
    if (data_->outputs[i].name == name) return {data_, i};
    known += (i == 0 ? "" : ", ") + data_->outputs[i].name;
  }
  throw Error(Exit::usage, "no output \"" + name + "\"; there is: " + (known.empty() ? "none" : known));
}
std::size_t Call::count() const { return data_->count; }
double Call::nanoseconds() const { return data_->median; }
double Call::nanosecondsLeast() const { return data_->least; }
double Call::nanosecondsMost() const { return data_->most; }

// --- the function ---------------------------------------------------------------------------------

struct Function::Impl {
  gpu::Device& device;
  Signature signature;
  Options options;
  std::vector<Parameter> arrays;
  std::vector<gpu::Buffer> arrayBuffers;
  std::vector<bool> arraySet;
  std::string source;
  std::vector<std::uint32_t> spirv;
  std::optional<gpu::Pipeline> pipeline;

  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(Exit::usage, "`" + signature.text() + "`: " + what);
  }
  std::size_t checkedCount(const std::vector<Values>& inputs, std::optional<std::size_t> count) const;
  gpu::Buffer filled(const Values& values) const;
};

Function::Function(gpu::Device& device, const std::string& snippet, const std::string& signature,
                   const Options& options)
    : impl_(new Impl{device, parseSignature(signature), options, {}, {}, {}, {}, {}, {}}) {
  Impl& f = *impl_;
  for (const std::string& array : options.arrays) f.arrays.push_back(parseArray(array));
  f.arrayBuffers.resize(f.arrays.size());
  f.arraySet.resize(f.arrays.size());
  constexpr std::size_t mostBuffers = 16;  // the fewest storage buffers a stage has on the devices this runs on
  std::size_t buffers = f.arrays.size() + f.signature.returns;
  for (const Parameter& p : f.signature.parameters) buffers += std::size_t{p.in} + std::size_t{p.out};
  if (buffers > mostBuffers) {
    f.refuse(std::to_string(buffers) + " arrays, inputs and outputs; at most " + std::to_string(mostBuffers) +
             " are possible: put scalars into vectors");
  }
  if (!f.signature.returns &&
      std::none_of(f.signature.parameters.begin(), f.signature.parameters.end(), [](auto& p) { return p.out; })) {
    f.refuse("returns nothing and has no out parameter, so there is nothing to test");
  }
  if (const std::size_t at = snippet.find("#version"); at != std::string::npos) {
    throw Error(
        Exit::shader,
        options.name + ":" +
            std::to_string(1 + std::count(snippet.begin(), snippet.begin() + static_cast<std::ptrdiff_t>(at), '\n')) +
            ": error: '#version' is written by the harness (460); leave it out");
  }

  f.source = shaderAround(snippet, options.name, f.signature, f.arrays);
  std::vector<std::filesystem::path> folders = options.folders;
  folders.insert(folders.end(), options.buildFolders.begin(), options.buildFolders.end());
  try {
    f.spirv = gpu::compileText(f.source, options.name, options.defines, folders).spirv;
  } catch (const Error& error) {
    throw Error(error.code(), explained(error.what(), snippet, options.name, f.signature));
  }
  if (const std::string invalid = gpu::validationError(f.spirv); !invalid.empty()) {
    throw Error(Exit::shader, options.name + ": error: the compiler made invalid SPIR-V of it: " + invalid);
  }
  f.pipeline.emplace(device.makePipeline(f.spirv, options.specialisation));
}
Function::~Function() = default;
Function::Function(Function&&) noexcept = default;

const std::vector<std::uint32_t>& Function::spirv() const { return impl_->spirv; }
const std::string& Function::source() const { return impl_->source; }

gpu::Buffer Function::Impl::filled(const Values& values) const {
  gpu::Buffer buffer = device.makeBuffer(std::max<std::size_t>(values.bytes().size(), 16), gpu::BufferUse::storage);
  std::memcpy(buffer.bytes().data(), values.bytes().data(), values.bytes().size());
  return buffer;
}

void Function::set(const std::string& array, const Values& values) {
  Impl& f = *impl_;
  for (std::size_t i = 0; i < f.arrays.size(); ++i) {
    if (f.arrays[i].name != array) continue;
    if (!(f.arrays[i].type == values.type())) {
      f.refuse("array \"" + array + "\" is " + name(f.arrays[i].type) + ", was given " + name(values.type()));
    }
    f.arrayBuffers[i] = f.filled(values);
    f.arraySet[i] = true;
    return;
  }
  f.refuse("no array \"" + array + "\" in Options::arrays");
}

std::size_t Function::Impl::checkedCount(const std::vector<Values>& inputs, std::optional<std::size_t> count) const {
  std::vector<const Parameter*> wanted;
  for (const Parameter& p : signature.parameters) {
    if (p.in) wanted.push_back(&p);
  }
  if (inputs.size() != wanted.size()) {
    refuse("wants " + std::to_string(wanted.size()) + " inputs, was given " + std::to_string(inputs.size()));
  }
  const Parameter* counted = nullptr;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Parameter& p = *wanted[i];
    if (!(inputs[i].type() == p.type)) {
      refuse("parameter \"" + p.name + "\" is " + name(p.type) + ", was given " + name(inputs[i].type()));
    }
    if (inputs[i].shared()) continue;
    if (count && *count != inputs[i].count()) {
      refuse("array lengths differ: " + (counted ? "\"" + counted->name + "\"" : "the call") + " has " +
             std::to_string(*count) + ", \"" + p.name + "\" has " + std::to_string(inputs[i].count()));
    }
    if (!count) count = inputs[i].count(), counted = &p;
  }
  if (!count) refuse("no argument is an array; callTimes() says how many elements there are");
  if (*count == 0) refuse("no elements");
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    if (!arraySet[i]) refuse("array \"" + arrays[i].name + "\" was not set");
  }
  return *count;
}

Call Function::call(std::vector<Values> inputs) {
  const std::size_t count = impl_->checkedCount(inputs, std::nullopt);
  return callTimes(count, std::move(inputs));
}

Call Function::callTimes(std::size_t count, std::vector<Values> inputs) {
  Impl& f = *impl_;
  f.checkedCount(inputs, count);
  auto data = std::make_shared<Output::Data>();
  data->count = count;

  std::vector<const gpu::Buffer*> bound;
  std::vector<gpu::Buffer> buffers;
  buffers.reserve(2 * f.signature.parameters.size() + 1);  // `bound` points into it
  for (const gpu::Buffer& array : f.arrayBuffers) bound.push_back(&array);
  std::vector<std::size_t> outputs;  // places in `buffers`
  const auto output = [&](const std::string& name, Type type) {
    buffers.push_back(f.device.makeBuffer(std::max<std::size_t>(count * type.bytes(), 16), gpu::BufferUse::readback));
    bound.push_back(&buffers.back());
    outputs.push_back(buffers.size() - 1);
    data->outputs.push_back({name, type, {}});
  };
  std::size_t next = 0;
  std::uint32_t constants[2] = {static_cast<std::uint32_t>(count), 0};
  for (std::size_t i = 0; i < f.signature.parameters.size(); ++i) {
    const Parameter& p = f.signature.parameters[i];
    if (p.in) {
      const Values& values = inputs[next++];
      if (values.shared()) constants[1] |= 1u << i;
      buffers.push_back(f.filled(values));
      bound.push_back(&buffers.back());
      data->inputs.emplace_back(p.name, values);
    }
    if (p.out) output(p.name, p.type);
  }
  if (f.signature.returns) output("return", f.signature.returned);

  const std::uint32_t groups = static_cast<std::uint32_t>((count + 63) / 64), across = std::min(groups, 32768u);
  const gpu::Dispatch dispatch{
      &*f.pipeline, bound, std::as_bytes(std::span(constants)), {across, (groups + across - 1) / across, 1}};
  f.device.run({&dispatch, 1});
  std::vector<double> times;
  for (int run = 0; run < std::max(f.options.runs, 1); ++run) times.push_back(f.device.run({&dispatch, 1}));
  std::sort(times.begin(), times.end());
  const double scale = 1e6 / static_cast<double>(count);
  data->median = times[times.size() / 2] * scale;
  data->least = times.front() * scale;
  data->most = times.back() * scale;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    Output::Data::Item& item = data->outputs[i];
    const auto bytes = buffers[outputs[i]].bytes().first(count * item.type.bytes());
    item.bytes.assign(bytes.begin(), bytes.end());
  }
  return Call(std::move(data));
}

}  // namespace solidcast::glsl_test
