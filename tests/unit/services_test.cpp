// SPDX-License-Identifier: Apache-2.0
// Services for plugins: the image decoder, as requested by a plugin, and its results.
#include "io/services.hpp"
#include "plugin_folder.hpp"

#include <restage/image.h>
#include <catch2/matchers/catch_matchers_string.hpp>

using namespace restage;
using Catch::Matchers::ContainsSubstring;

namespace {

const RestageImageService1& images() {
    for (const plugin::HostService& service : io::services())
        if (std::string(service.id) == RESTAGE_IMAGE_SERVICE)
            return *static_cast<const RestageImageService1*>(service.table);
    FAIL("there is no " RESTAGE_IMAGE_SERVICE);
    std::abort();
}

const std::filesystem::path folder_of_images = restage::test::source_dir() / "tests/data/images";

} // namespace

TEST_CASE("a program with an image decoder offers it to plugins; one without it refuses plugins that need it",
          "[services]") {
    test::PluginFolder folder;
    const auto json =
        test::manifest(R"("restage.material/1")", R"("host": ">=0.2", "interfaces": ["restage.image/1"])");
    folder.add("p", json, "pictures");
    CHECK_THAT(folder.refusal(),
               ContainsSubstring("plugin.json: needs restage.image/1, which this program does not have"));
    folder.lines.clear();
    plugin::Registry registry(folder.log, io::with_services());
    folder.scan(registry);
    REQUIRE(registry.entries().size() == 1);
    INFO(registry.entries()[0]->reason);
    CHECK(registry.entries()[0]->state == plugin::State::loaded);
    const std::string said = R"(org.example.velvet: 16 x 8, 1 of 16 bits, problem "")";
    CHECK(std::count(folder.lines.begin(), folder.lines.end(), said) == 1);
}

TEST_CASE("a plugin that does not require the service gets NULL", "[services]") {
    test::PluginFolder folder;
    folder.add("p", test::manifest(R"("restage.material/1")"), "pictures");
    CHECK_THAT(folder.refusal(), ContainsSubstring("its init function reports failure")); // it received NULL
}

TEST_CASE("the decoder returns texels as stored, and errors name the file", "[services]") {
    const RestageImageService1& service = images();
    const auto path = folder_of_images / "grey16.png";
    RestageDecodedImage image{};
    REQUIRE(service.decode(nullptr, nullptr, 0, path.string().c_str(), &image) == 1);
    CHECK(image.width == 16);
    CHECK(image.height == 8);
    CHECK(image.channels == 1);
    REQUIRE(image.bits == 16);
    CHECK(static_cast<const std::uint16_t*>(image.texels)[3] == 3 * 256 + 77);
    CHECK(std::string(image.problem).empty());

    const auto bytes = read_file(folder_of_images / "rgba8.png");
    REQUIRE(bytes);
    RestageDecodedImage embedded{};
    REQUIRE(service.decode(nullptr, bytes->data(), bytes->size(), "image 3", &embedded) == 1);
    CHECK(embedded.bits == 8);
    CHECK(embedded.channels == 4);
    service.release(nullptr, &image);
    CHECK(image.texels == nullptr);
    service.release(nullptr, &image); // nothing is left to release
    CHECK(static_cast<const std::uint8_t*>(embedded.texels)[3] == 128);
    service.release(nullptr, &embedded);

    CHECK(service.decode(nullptr, bytes->data(), 50, "image 3", &image) == 0);
    CHECK(image.texels == nullptr);
    CHECK(std::string(image.problem).starts_with("image 3: truncated"));
    service.release(nullptr, &image);
    CHECK(service.decode(nullptr, nullptr, 0, "/no/such.png", &image) == 0);
    CHECK(std::string(image.problem).starts_with("/no/such.png: cannot be opened"));
    service.release(nullptr, &image);
    CHECK(image.problem == nullptr);
}

TEST_CASE("a plugin with a shorter struct gets the members it knows", "[services]") {
    const auto path = folder_of_images / "grey16.png";
    RestageDecodedImage image{};
    image.size = offsetof(RestageDecodedImage, channels); // from a header that ended there
    image.channels = 77;
    REQUIRE(images().decode(nullptr, nullptr, 0, path.string().c_str(), &image) == 1);
    CHECK(image.width == 16);
    CHECK(image.channels == 77);
}
