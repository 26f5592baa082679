#include "tracker_server/camera/vhp_camera.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "protocol/transport/certificates.hpp"
#include "protocol/transport/endpoint.hpp"
#include "tests/support/inbound.hpp"
#include "tests/support/link_options.hpp"
#include "tests/support/program.hpp"

namespace counterpart {
namespace {

using testing_support::joined;
using testing_support::options_of;
using testing_support::TemporaryFolder;

constexpr std::int64_t kSecond = 1'000'000'000;

VideoFrame grey_picture() {
  VideoFrame picture;
  picture.stamp.frame_id = 7;
  picture.width = 8;
  picture.height = 6;
  picture.stride = 24;
  picture.bytes.assign(std::size_t{24} * 6, 90);
  return picture;
}

// A camera host that wants both: a token, and TLS.
class VhpCameraAccess : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(access_.token_file) << "0123456789abcdef0123456789abcdef\n";
    std::filesystem::permissions(access_.token_file, std::filesystem::perms::owner_read);
    ASSERT_TRUE(make_certificates(folder_.path("keys"), {"camera", "tracker"}, std::chrono::days(2)));
    LinkOptions options = options_of(Role::camera);
    options.token_file = access_.token_file;
    options.tls_file = folder_.path("keys/camera.pem");
    auto host = listen_tcp("127.0.0.1:0", options);
    ASSERT_TRUE(host) << host.error().message;
    host_ = std::move(*host);
  }

  Result<std::unique_ptr<Camera>> open(const CameraAccess& access) const {
    return open_camera("vhp://" + host_->address(), Pace::realtime, access);
  }

  TemporaryFolder folder_;
  CameraAccess access_{folder_.path("token"), folder_.path("keys/tracker.pem")};
  std::unique_ptr<Endpoint> host_;
};

TEST_F(VhpCameraAccess, GivesItsPicturesToWhoHasTokenAndCertificate) {
  auto camera = open(access_);
  ASSERT_TRUE(camera) << camera.error().message;
  ASSERT_NE(joined(*host_), 0U);
  host_->broadcast(grey_picture());
  const auto frame = (*camera)->next();
  ASSERT_TRUE(frame && *frame);
  EXPECT_EQ((*frame)->stamp.frame_id, 7U);
  EXPECT_EQ((*frame)->image_bgr.at<cv::Vec3b>(3, 3), cv::Vec3b(90, 90, 90));
}

TEST_F(VhpCameraAccess, TurnsAwayWhoHasOnlyTheCertificateAndSaysWhatIsMissing) {
  const auto camera = open({"", access_.tls_file});
  ASSERT_FALSE(camera);
  EXPECT_NE(camera.error().message.find("--camera-token-file"), std::string::npos) << camera.error().message;
}

TEST_F(VhpCameraAccess, TurnsAwayWhoSpeaksNoTlsAndSaysWhatIsMissing) {
  const auto camera = open_vhp_camera(host_->address(), Pace::realtime, {access_.token_file, ""}, kSecond);
  ASSERT_FALSE(camera);
  EXPECT_NE(camera.error().message.find("--camera-tls-file"), std::string::npos) << camera.error().message;
}

}  // namespace
}  // namespace counterpart
